"""Where every constant of the diagnosis is from, and whether healthy sets of a user's rig replace it.

Name, value and meaning stand where a constant is used; `tests.builders.constants_page` joins them with these
entries to one table.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

Kind = Literal["fit", "literature", "choice", "definition"]
"""fit: to sets of the virtual rig; choice: of the method, by trials or by judgement; definition: of units, formats."""


@dataclass(frozen=True)
class Source:
    """Unit, kind of source and source of a constant; replaced : by `rigdesign calibrate`."""

    unit: str
    kind: Kind
    text: str
    replaced: bool = False


_HEALTHY = "marginal likelihood of 76 healthy sets of the virtual rig, three rigs"
_PAIRS = "marginal likelihood of 80 pairs of healthy sets of the virtual rig, three rigs"
_TRIALS = "trials with two simulators, before the first score"
_DEVELOPMENT = "chosen on the development split of the blind score"
_JUDGEMENT = "judgement, not fitted"
_PRACTICE = "rig practice"
_NUMERICS = "numerical method"
_TIME = "computing time"
_REPORT = "what a reader wants to see"

SOURCES: Mapping[str, Source] = {
    "decision.defaults.AMPLITUDES": Source("-", "fit", _HEALTHY, replaced=True),
    "decision.defaults.AMPLITUDES.sensor": Source(
        "-", "definition", "uncertainties as the measurement states them"
    ),
    "decision.defaults.AMPLITUDES.input": Source(
        "-", "definition", "uncertainties as the measurement states them"
    ),
    "decision.defaults.REAL_MODEL": Source("-", "choice", f"{_PRACTICE}; not used with a file of the rig"),
    "decision.defaults.INFLATION": Source(
        "coordinate", "fit", "108 healthy sets of the virtual rig, three rigs"
    ),
    "decision.defaults.DRIFT": Source("-", "fit", _PAIRS, replaced=True),
    "decision.defaults.DRIFT.sensors": Source(
        "-",
        "choice",
        f"{_PRACTICE}: 0.15 K of a thermocouple of 0.4 K, 0.35 % of a power of 1 %",
        replaced=True,
    ),
    "decision.defaults.DRIFT.constants": Source(
        "-",
        "choice",
        f"{_PRACTICE}: friction of flanks, bearings and seals 1 to 3 %, films 2 %",
        replaced=True,
    ),
    "decision.defaults.DRIFT.inflation": Source(
        "coordinate", "fit", "108 pairs of healthy sets of the virtual rig, three rigs"
    ),
    "decision.defaults.SIGNATURE_ERROR": Source(
        "-",
        "fit",
        "traces of 22 effects in the virtual rig; not_steady: second score; circuit: four models of two loops",
    ),
    "decision.defaults.PLAIN": Source(
        "-", "fit", "development split of the blind score; evidence: largest of 108 healthy sets"
    ),
    "decision.defaults.GIVEN_BASELINE": Source(
        "-", "fit", "development split of the blind score; evidence: largest of healthy pairs"
    ),
    "decision.defaults.RARE": Source("sd", "fit", "108 healthy sets and 108 pairs of the virtual rig"),
    "decision.workflow.NO_LONGER": Source("-", "choice", "60 sets of changed circuits"),
    "decision.search.WIDE": Source("-", "choice", "60 sets of changed circuits"),
    "residual.healthy.SHARES": Source("-", "choice", "60 sets of changed circuits"),
    "decision.decision.PROBABLE": Source("-", "choice", "more never were in a group of three"),
    "decision.decision.BY_LAW": Source("-", "choice", "opened sets of the fourth score"),
    "decision.decision.BY_ITSELF": Source("-", "choice", "opened sets of the fourth score"),
    "decision.decision.PRIOR": Source("-", "choice", _TRIALS),
    "catalogue.lateral.GENERAL_GRADE": Source("mm/s", "literature", "ISO 21940-11, table 1"),
    "catalogue.lateral.TIMES_GENERAL": Source("-", "choice", _PRACTICE),
    "catalogue.lateral.HEALTHY_GRADE": Source("mm/s", "literature", "ISO 21940-11, table 1"),
    "catalogue.lateral.HEALTHY_SHARE": Source("-", "choice", "half a tolerance as two standard deviations"),
    "catalogue.lateral.LARGEST_BOW": Source("m", "choice", _PRACTICE),
    "catalogue.lateral.HEALTHY_BOW": Source("m", "choice", _PRACTICE),
    "catalogue.lateral.LARGEST_TILT": Source("rad", "choice", _PRACTICE),
    "catalogue.lateral.HEALTHY_TILT": Source("rad", "choice", _PRACTICE),
    "catalogue.lateral.LARGEST_ANGLE": Source("rad", "choice", _PRACTICE),
    "catalogue.lateral.LEAST_ANGLE": Source("rad", "choice", _PRACTICE),
    "catalogue.lateral.CLEARANCE_SPREAD": Source("-", "choice", _PRACTICE),
    "catalogue.lateral.SUPPORT_SPREAD": Source("-", "choice", _JUDGEMENT),
    "catalogue.local_heat.TIGHT": Source("-", "choice", _PRACTICE),
    "catalogue.local_heat.UNEVEN": Source("-", "choice", _PRACTICE),
    "catalogue.local_heat.FAN": Source("-", "choice", _PRACTICE),
    "catalogue.local_heat.DRAUGHTY": Source("-", "choice", _PRACTICE),
    "residual.sensors.LAG": Source("s", "choice", _PRACTICE),
    "residual.sensors.LARGEST_LAG": Source("s", "choice", _PRACTICE),
    "decision.held_out_data.REMAINDER": Source("-", "choice", _JUDGEMENT),
    "decision.held_out_data.AGREEMENT": Source("-", "choice", _JUDGEMENT),
    "decision.held_out_data.INCLUSION": Source("-", "choice", "as large as for a name"),
    "decision.held_out_data.CATALOGUE": Source("-", "choice", _JUDGEMENT),
    "decision.held_out_data.LARGEST_GROUP": Source("-", "choice", _JUDGEMENT),
    "decision.claims.APART": Source("-", "choice", _JUDGEMENT),
    "decision.claims.FAINT": Source("sd", "choice", _JUDGEMENT),
    "decision.claims.UNEQUAL": Source("-", "choice", "frozen set 01"),
    "decision.claims.DISAGREEMENT": Source("-", "choice", "opened sets of the fourth score"),
    "decision.proposals.SEED": Source("-", "definition", "any number"),
    "statistics.next_measurement.MOST_TOGETHER": Source("-", "choice", _REPORT),
    "statistics.detectability.REACHES": Source("-", "choice", _DEVELOPMENT),
    "decision.claims.SIZES": Source("-", "choice", _NUMERICS),
    "decision.patch.NARROWED": Source(
        "-", "choice", "a constant known hardly better stays as the case has it"
    ),
    "decision.search.LEADERS": Source("-", "choice", _TIME),
    "decision.search.UNNAMED_LEADERS": Source("-", "choice", _TIME),
    "decision.search.COPY": Source("-", "choice", _DEVELOPMENT),
    "decision.search.PARTNERS": Source("-", "choice", _TIME),
    "decision.naming.DIGITS": Source("-", "definition", "format"),
    "decision.naming._SCALES": Source("-", "definition", "units"),
    "decision.proposals.RIVALS": Source("-", "choice", _REPORT),
    "decision.search.MOST_EFFECTS": Source("-", "choice", _JUDGEMENT),
    "decision.workflow.LEAST_RUNNING_POINTS": Source("-", "choice", _JUDGEMENT),
    "catalogue.circuit.MICROMETRE": Source("m", "definition", "units"),
    "catalogue.circuit.LEAST_TORQUE": Source("N m", "choice", _PRACTICE),
    "catalogue.circuit.LEAST_SOFTENING": Source(
        "-", "choice", "stiffness of a tooth over the depth of a crack"
    ),
    "catalogue.gauges.MICROMETRE": Source("m", "definition", "units"),
    "catalogue.gauges.AXES": Source("m", "choice", _PRACTICE),
    "catalogue.gauges.MODIFICATION": Source("-", "choice", _PRACTICE),
    "catalogue.gauges.LEAST_MODIFICATION": Source("m", "choice", _PRACTICE),
    "catalogue.gauges.PLACE": Source("m", "choice", _PRACTICE),
    "catalogue.gauges.LEAST_LAG": Source("s", "choice", _JUDGEMENT),
    "catalogue.gauges.LONGEST_LAG": Source("s", "choice", _PRACTICE),
    "residual.healthy.MODEL_ERROR": Source("-", "literature", "P1, Figure 9; tilt and curvature: judgement"),
    "residual.healthy.POINT_ERROR": Source("-", "choice", _JUDGEMENT),
    "residual.sensors.THERMAL_OUTPUT": Source("1/K", "choice", _PRACTICE),
    "residual.sensors.CENTRIFUGAL": Source("-", "choice", _PRACTICE),
    "residual.metrology.REACH": Source("-", "choice", _JUDGEMENT),
    "statistics.detectability.MOST": Source("of the bound", "choice", _NUMERICS),
    "statistics.detectability.ALIKE": Source("-", "choice", _JUDGEMENT),
    "document.document.LEAST_GAUGES": Source("-", "definition", "a mode needs gauges to differ"),
    "document.outcome.FAR": Source("of the bound", "choice", _REPORT),
    "document.outcome.MOST_FACTOR": Source("-", "choice", _REPORT),
    "decision.proposals.MOST_BEYOND": Source("of the bound", "choice", _JUDGEMENT),
    "decision.proposals.LOCATED": Source("posterior mass", "choice", _JUDGEMENT),
    "decision.proposals.EXPLAINS": Source("-", "choice", _REPORT),
    "catalogue.effects.FEWER_SIZES": Source("of the bound", "choice", _TIME),
    "catalogue.effects.YIELDING_SIZES": Source("of the bound", "choice", _TIME),
    "catalogue.heat.FLOW_METER": Source("-", "choice", _PRACTICE),
    "catalogue.heat.FLOWS": Source("-", "choice", _PRACTICE),
    "catalogue.heat.IN_MIST": Source(
        "-", "literature", "films on rotating parts, `thermal.films.convection`"
    ),
    "catalogue.heat.IN_BEARING": Source(
        "-", "literature", "laminar film, Nu 2 to 6, `thermal.films.convection`"
    ),
    "catalogue.heat.LOOSE": Source("m2 K/W", "choice", "conduction through an air gap of 0.1 mm"),
    "catalogue.heat.PRESSED": Source("m2 K/W", "choice", _JUDGEMENT),
    "document.advice.NOTABLE": Source("-", "choice", _REPORT),
    "document.advice.WORTH": Source("-", "choice", _REPORT),
    "document.advice.LARGEST_ODDS": Source("-", "choice", _REPORT),
    "document.advice.MOST_PROPOSED": Source("-", "choice", _REPORT),
    "document.document.SCHEMA": Source("-", "definition", "format"),
    "document.outcome.SHOWN": Source("-", "choice", _REPORT),
    "library.build.BATCH": Source("-", "choice", _TIME),
    "library.build.LINEAR_SHARE": Source("of the bound", "choice", _NUMERICS),
    "library.build.OSCILLATION_SHARE": Source("of the bound", "choice", _NUMERICS),
    "library.cache.SCHEMA": Source("-", "definition", "format"),
    "library.candidates.NOISE": Source("SI", "choice", f"{_PRACTICE}: usual sensors"),
    "library.candidates.USUAL_COST": Source("thermocouples", "choice", _PRACTICE),
    "library.candidates.MOST_TEMPERATURES": Source("-", "choice", _TIME),
    "residual.baseline.TWINS": Source("-", "choice", _DEVELOPMENT),
    "residual.baseline.HANDBOOK": Source("-", "choice", _JUDGEMENT),
    "residual.hypotheses.COMMON": Source("-", "choice", _JUDGEMENT),
    "residual.hypotheses.STEP": Source("rad", "choice", _NUMERICS),
    "residual.hypotheses._MISREAD": Source("-", "definition", "units"),
    "residual.hypotheses._TEMPERATURE": Source("-", "definition", "units"),
    "residual.hypotheses._TORQUE": Source("-", "definition", "units"),
    "residual.healthy.TREND": Source("-", "choice", _JUDGEMENT),
    "residual.hypotheses.SIGMAS": Source("-", "choice", _JUDGEMENT),
    "residual.hypotheses.INVISIBLE": Source("-", "choice", _NUMERICS),
    "residual.residual_problem.BENDING_STEPS": Source("-", "choice", _NUMERICS),
    "residual.residual_problem.BENDING_SHARE": Source("-", "choice", _NUMERICS),
    "residual.sensors.TIMES": Source("-", "choice", _JUDGEMENT),
    "residual.sensors.ANGLE_ZERO": Source("rad", "choice", _PRACTICE),
    "residual.sensors.LARGEST_ANGLE_ERROR": Source("rad", "choice", "20 times its healthy error"),
    "residual.healthy.CONTENDERS": Source("-", "choice", _TIME),
    "residual.healthy.SLIGHT": Source("-", "choice", _NUMERICS),
    "residual.healthy.MOST_ALONE": Source("-", "choice", _TIME),
    "rig_calibration.estimate.STANDS_OUT": Source("variances", "choice", "two standard deviations"),
    "rig_calibration.estimate.WORTH_A_SHIFT": Source("-", "choice", _JUDGEMENT),
    "rig_calibration.estimate.LARGEST_SHIFT": Source("-", "choice", _NUMERICS),
    "rig_calibration.document.SCHEMA": Source("-", "definition", "format"),
    "rig_calibration.estimate.FEWEST": Source("-", "definition", "one pair"),
    "rig_calibration.estimate.MOST": Source("-", "choice", _TIME),
    "rig_calibration.healthy_sets.LEAST_AGAIN": Source("-", "choice", "as LEAST_RUNNING_POINTS"),
    "run.HIGHEST": Source("-", "choice", _PRACTICE),
    "statistics.detectability.SEEN": Source(
        "-", "literature", "normal distribution, 5 % error on both sides"
    ),
    "statistics.detectability.SEPARATED": Source("-", "choice", _TRIALS),
    "statistics.detectability.ALIAS": Source("-", "choice", _TRIALS),
    "statistics.evidence.SPREADS": Source("of the bound", "choice", _TRIALS),
    "statistics.evidence.GRID": Source("-", "choice", _NUMERICS),
    "statistics.evidence.ROUNDS": Source("-", "choice", _NUMERICS),
    "statistics.evidence.ALIKE": Source("-", "choice", _NUMERICS),
    "statistics.heldout.LEAST_POINTS": Source("-", "choice", _JUDGEMENT),
    "statistics.heldout.SHARE": Source("-", "choice", _JUDGEMENT),
    "statistics.heldout.OWN": Source("-", "choice", _JUDGEMENT),
    "statistics.evidence.NORMAL_95": Source("-", "literature", "normal distribution"),
    "statistics.evidence.FINE": Source("-", "choice", _NUMERICS),
    "statistics.amplitudes.PRIOR": Source("-", "choice", "a factor of 4.5 between rigs"),
    "statistics.amplitudes.FARTHEST": Source("-", "choice", _NUMERICS),
    "statistics.amplitudes.CURVATURE_STEP": Source("-", "choice", _NUMERICS),
    "statistics.next_measurement.TELLS": Source("-", "choice", _JUDGEMENT),
    "statistics.covariance.LIMIT": Source("-", "choice", _JUDGEMENT),
    "statistics.covariance.MOST_REJECTED": Source("-", "choice", _JUDGEMENT),
    "statistics.columns.AMBIENT": Source("K", "choice", "room temperature"),
    "statistics.resonance.FREQUENCY_ERROR": Source(
        "-", "fit", "as ``decision.defaults.AMPLITUDES.frequency``"
    ),
    "statistics.resonance.DAMPING_RATIO": Source("-", "choice", "least of the first modes of three rigs"),
}
"""Module and name, as ``decision.defaults.DRIFT`` -> source; a field or key of a constant may have its own entry."""
