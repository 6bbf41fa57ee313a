"""Cases whose shafts have no damping of their own."""

from rigdesign.case.model import Case


def undamped_shafts(case: Case) -> dict[str, object]:
    """Values by path that take the damping of steel from every shaft of the drivetrain."""
    assert case.drivetrain is not None
    return {f"drivetrain.shafts.{name}.material_damping": 0.0 for name in case.drivetrain.shafts}
