"""Ranges of a made-up run, for tests of the first page."""

from rigdesign.results.ranges import CheckRange, RangedInput, RangeMargin, RangesResult


def ranges():
    """A failing check that a torque turns, one that nothing turns, and one that holds and that a gap breaks."""

    def row(name, verdict, margin, decided):
        return CheckRange(
            check=name, unit="mm", verdict_stated=verdict, verdict=verdict, margin=margin, worst_margin=margin,
            worst_path=None, worst_value=None, best_margin=None, best_path=None, distance=0.5,
            worst_distance=None, best_distance=None, all_worst_margin=None, decided_by=decided,
        )  # fmt: skip

    def given(path, stated, low, high):
        return RangedInput(
            path=path, together_with=(), stated=stated, low=low, high=high, solved_again=(),
            max_temperature_low_degC=None, max_temperature_high_degC=None,
        )  # fmt: skip

    def margin(check, path, low, high):
        return RangeMargin(
            check=check, path=path, unit="mm", margin_low=low, margin_high=high, distance_low=0.6,
            distance_high=0.1, verdict_low=None, verdict_high=None,
        )  # fmt: skip

    return RangesResult(
        fidelity="quick", method="solved",
        inputs=[given("torque", "180 N m", "100 N m", "200 N m"), given("gap", "60 um", "40 um", "80 um")],
        checks=[row("x", "fail", -1.0, ("torque",)), row("y", "fail", -1.0, ()), row("z", "pass", 1.0, ("gap",))],
        margins=[margin("x", "torque", 3.0, -2.0), margin("y", "gap", -0.5, -0.8), margin("z", "gap", -1.0, 2.0)],
        max_temperature=None, left_out=[],
    )  # fmt: skip
