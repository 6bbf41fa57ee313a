"""Points of a study with closed forms for margins, so that crossings are known by hand."""

from rigdesign.report.pages.study import write_study
from rigdesign.studies.grid import Variation
from rigdesign.studies.result import CheckSelection, StudyPoint, StudyResult

OIL, TORQUE, WIDTH = (
    "gearboxes.test.oil.inlet_temperature",
    "schedule.test_torque",
    "gearboxes.test.face_width",
)


class ExampleStudyCase:
    """What a page shows of a case."""

    name = "example"
    title = "Example <rig>"
    hash = "0123456789abcdef" * 4


def check_record(identity, value, limit, *, comparison="<=", group="temperatures", title=None):
    """A check as the ledger holds it: distance as `rigdesign.checks.rules` counts it, from zero."""
    upper = comparison == "<="
    margin = limit - value if upper else value - limit
    distance = margin / limit if upper or margin < 0.0 else margin / value
    return {
        "id": identity, "title": title or identity.replace(".", " "), "group": group, "value": value, "limit": limit,
        "upper_limit": None, "unit": "mm", "comparison": comparison, "margin": margin, "distance": distance,
        "verdict": "pass" if margin >= 0 else "fail", "flags": [],
    }  # fmt: skip


def rig_checks(oil, torque=100.0):
    """A clearance that closes at 118 degC (100 N m), an outlet at its limit at 150 degC, a stress over it from 200 N m.

    One check always fails, one has nothing left and never moves.
    """
    return [
        check_record("specimen.root_stress.pinion", 2000.0, 950.0, group="specimen", title="root stress, ISO 6336-3"),
        check_record("specimen.contact.pinion", 5.0 * torque, 1000.0, group="specimen", title="contact stress"),
        check_record("clearance.tip", 0.768 - 0.006 * oil - 0.0001 * (torque - 100.0), 0.06, comparison=">=",
                     group="clearances", title="hot tip clearance"),
        check_record("temperature.outlet", oil + 10.0, 160.0, title="hottest oil outlet"),
        check_record("ramp.standstill", 10.0, 10.0, group="ramp", title="torque at standstill"),
    ]  # fmt: skip


def point(values, checks=None, error="temperature: 3 K above the limit of 0.05 K; relax the loop"):
    """A computed point, or one without result where ``checks`` is None."""
    if checks is None:
        return StudyPoint(values=values, failed=True, record={"error": error})
    verdict = "fail" if any(check["verdict"] == "fail" for check in checks) else "pass"
    record = {"verdict": verdict, "max_temperature_degC": 120.0, "checks": checks}
    return StudyPoint(values=values, failed=False, record=record)


def oil_points(temperatures, failed=()):
    """A study over the oil temperature [degC]; those of ``failed`` have no result."""
    return [point({OIL: f"{oil:g} degC"}, None if oil in failed else rig_checks(oil)) for oil in temperatures]


def map_points(temperatures, torques, failed=()):
    """A grid over oil temperature [degC] and torque [N m]."""
    return [
        point(
            {OIL: f"{oil:g} degC", TORQUE: f"{torque:g} N m"},
            None if (oil, torque) in failed else rig_checks(oil, torque),
        )
        for oil in temperatures
        for torque in torques
    ]


def study_of(points, design="grid", **found):
    """The study that has these points."""
    paths = list(points[0].values)
    variations = [Variation(p, tuple(dict.fromkeys(q.values[p] for q in points))) for p in paths]
    return StudyResult(
        case=ExampleStudyCase(),
        fidelity="quick",
        design=design,
        variations=variations,
        points=points,
        **found,
    )


def written(points, out, *patterns, design="grid", **found):
    """Files of the study in ``out``."""
    write_study(study_of(points, design, checks=CheckSelection(patterns), **found), out)
    return out
