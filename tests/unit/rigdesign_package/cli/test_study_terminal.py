"""What `rigdesign study` prints: the answer, what failed, where the files are."""

from pathlib import Path

from rigdesign.cli.terminal.study import print_study
from rigdesign.results.check import Finding
from rigdesign.studies.result import PassProbability, SobolIndex, Swing
from rigdesign.studies.run import StudyOutcome
from tests.builders.study_points import map_points, oil_points, study_of


def printed(capsys, points, **found):
    print_study(StudyOutcome(result=study_of(points, **found), completed=len(points), reused=0), Path("out"))
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 80
    return " ".join(line.strip() for line in lines), lines


def test_one_input_is_answered_in_two_sentences(capsys):
    text, lines = printed(capsys, oil_points((90, 110, 130, 150), failed=(150,)))
    assert "“root stress, ISO 6336-3” fails at every point." in text
    assert "Everything else passes up to 118 °C; the limiting check is “hot tip clearance”." in text
    assert "failed: gearboxes.test.oil.inlet_temperature = 150 degC: temperature: 3 K above" in text
    assert lines[-3:] == [
        "4 points computed, 0 found done",
        str(Path("out/study.html")),
        str(Path("out/results.csv")),
    ]


def test_two_inputs_are_answered_at_every_value_of_the_second(capsys):
    text, _ = printed(capsys, map_points((90, 110, 130), (100, 220)))
    assert "schedule test torque 100 N m: passes up to 118 °C; the limiting check is" in text
    assert "schedule test torque 220 N m: fails at every point" in text


def test_many_failed_points_are_counted(capsys):
    text, _ = printed(capsys, oil_points(range(80, 100), failed=range(80, 92)))
    assert text.count("failed: gearboxes") == 5 and "7 more points failed: see results.csv" in text


def test_one_point_is_counted_as_one(capsys):
    text, _ = printed(capsys, oil_points((90,)))
    assert "1 point computed, 0 found done" in text


def test_indices_and_ends_of_the_inputs_are_printed_nearest_check_first(capsys):
    inputs = ("gearboxes.*.oil.inlet_temperature", "schedule.test_torque")
    indices = [
        SobolIndex(check=check, path=path, first_order=0.2, first_order_interval=(0.1, 0.3), total=share,
                   total_interval=(share - 0.05, share + 0.05))
        for check in ("temperature.outlet", "clearance.tip")
        for path, share in zip(inputs, (0.25, 0.75), strict=True)
    ]  # fmt: skip
    swings = [
        Swing(check="clearance.tip", path=path, low="low", high="high", distance_stated=0.2, distance_low=0.25,
              distance_high=1.0 - high)
        for path, high in zip(inputs, (0.85, 1.1), strict=True)
    ]  # fmt: skip
    swings.append(
        Swing(check="temperature.outlet", path=inputs[0], low="low", high="high", distance_stated=0.5,
              distance_low=0.5, distance_high=0.5)
    )  # fmt: skip
    text, lines = printed(capsys, oil_points((90, 110)), design="sobol", indices=indices, swings=swings)
    assert (
        "hottest oil outlet: schedule test torque 0.75 (0.70 to 0.80), oil inlet temperature of every gearbox 0.25 "
        "(0.20 to 0.30)"
    ) in text
    assert text.index("hottest oil outlet: schedule") < text.index("hot tip clearance: schedule")
    assert (
        "hot tip clearance: schedule test torque 25 and −10 %, oil inlet temperature of every gearbox 25 and 15 %"
    ) in text
    assert sum(line.startswith("  hottest oil outlet") for line in lines) == 1, "its margin does not move"


def test_samples_say_how_often_all_and_the_least_likely_hold(capsys):
    all_hold = PassProbability(check="all", probability=0.4, low=0.3, high=0.5, samples=4)
    tip = PassProbability(check="clearance.tip", probability=0.55, low=0.4, high=0.7, samples=4)
    sure = PassProbability(check="temperature.outlet", probability=1.0, low=0.9, high=1.0, samples=4)
    warning = Finding(id="study.indices", text="Sobol indices are not given")
    text, _ = printed(
        capsys, oil_points((90, 100, 110, 130)), design="latin hypercube", all_hold=all_hold,
        probabilities=[sure, tip], warnings=[warning],
    )  # fmt: skip
    assert "All checks hold: 40 % of 4 samples (95 %: 30 to 50 %)" in text
    assert "hot tip clearance: 55 % of 4 samples (95 %: 40 to 70 %)" in text
    assert "hottest oil outlet: " not in text and "warning: Sobol indices are not given" in text
