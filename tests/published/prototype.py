"""The shipped prototype case and its variants, as the rows of the UHCF paper (P2) need them."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from pathlib import Path

from dynamics.gear.pair import GearPair
from dynamics.rating.iso_rating import RatingOptions
from rigdesign.case import Case, load_case
from rigdesign.case.loader import changed_together
from rigdesign.rig.gears import build_pair
from rigdesign.rig.model import Rig, build_rig

RPM = pi / 30.0
"""[rad/s] per revolution per minute."""
TEST_TORQUE = 180.0
"""Torque of the test pinion in P2's simulation [N m]."""
TEST_MESH, REFERENCE_MESH = "test.main", "reference.main"


@dataclass(frozen=True)
class Prototype:
    """The prototype in the readings that P2 leaves open; everything is computed once, when asked for."""

    folder: Path

    @cached_property
    def rig(self) -> Rig:
        """The rig of case.toml: test gear x1 = 0, reference tips cut to the printed contact ratio."""
        return build_rig(load_case(self.folder))

    @cached_property
    def simulated(self) -> Rig:
        """The rig of P2's own simulation: constant bearing drag, no motor (run_up_simulation.toml).

        Its tooth stiffness is that of ISO 6336-1, as in a multi-body program: the analytic teeth; shafts only twist.
        """
        case = load_case(self.folder / "run_up_simulation.toml")
        return replace(_as_simulated(case), shaft_model="torsional")

    @cached_property
    def bending(self) -> Rig:
        """The same with shafts that bend in the bearings of Table 1.

        As P2 models it: one half of the double-helical gears, single-helical, both of its shafts fixed axially.
        """
        return _as_simulated(self._table_1({
            "gearboxes.reference.meshes.main.double_helical": False,
            "gearboxes.reference.bearings.pinion_front.locating": True,
        }))  # fmt: skip

    @cached_property
    def both_halves(self) -> Rig:
        """The same with both halves of the double-helical gears in mass and inertia; their axial forces cancel."""
        gears = ("pinion", "wheel")
        return _as_simulated(
            self._table_1(
                {
                    "gearboxes.reference.meshes.main.carrying_halves": 2,
                    **{f"gearboxes.reference.gears.{gear}.inertia_factor": 2.0 for gear in gears},
                }
            )
        )

    def _table_1(self, values: Mapping[str, object]) -> Case:
        stated = {"drivetrain.bearing_coefficients": "stated"}
        return changed_together(load_case(self.folder / "run_up_simulation.toml"), {**stated, **values})

    @cached_property
    def full_addendum(self) -> Case:
        """Variant with full addendum of the reference gears."""
        return load_case(self.folder / "full_addendum.toml")

    @cached_property
    def test_pair(self) -> GearPair:
        """Test gears as solid steel discs, x1 = 0, wheel tips shortened."""
        return _solid(self.rig.pairs[TEST_MESH])

    @cached_property
    def equal_shifts(self) -> GearPair:
        """Test gears with x1 = x2 instead of x1 = 0."""
        return self._with_shift("test", None)

    @cached_property
    def reference_pair(self) -> GearPair:
        """Reference gears as solid steel discs, x1 = x2, both tips cut to the printed total contact ratio."""
        return _solid(self.rig.pairs[REFERENCE_MESH])

    @cached_property
    def unshifted_reference_pair(self) -> GearPair:
        """The same with x1 = 0 instead of x1 = x2."""
        return self._with_shift("reference", 0.0)

    @cached_property
    def full_reference_pair(self) -> GearPair:
        """Reference gears with full addendum, x1 = x2."""
        box = self.full_addendum.gearboxes["reference"]
        return _solid(build_pair(box, box.meshes["main"], self.rig.materials))

    def _with_shift(self, box_name: str, first: float | None) -> GearPair:
        """Gear pair of a gearbox with another split: the pinion's shift [-], or equal shifts."""
        box = self.rig.case.gearboxes[box_name]
        entry = box.meshes["main"]
        mesh = entry.model_copy(update={"profile_shift_split": "equal" if first is None else None})
        pinion = box.gears[entry.pinion].model_copy(update={"profile_shift": first})
        changed = box.model_copy(update={"gears": {**box.gears, entry.pinion: pinion}})
        return _solid(build_pair(changed, mesh, self.rig.materials))


def _as_simulated(case: Case) -> Rig:
    """Rig with the tooth stiffness of a multi-body program, that of ISO 6336-1."""
    return replace(build_rig(case), mesh_stiffness="iso_6336_scaled")


def _solid(pair: GearPair) -> GearPair:
    """Bodies as ISO 6336-1 takes them without further data: solid discs of steel."""
    return replace(pair, bore_diameters=(0.0, 0.0), densities=(7830.0, 7830.0), youngs_moduli=(206e9, 206e9))


TEST_OPTIONS = RatingOptions(grade=5, tip_relief=7e-6, low_load_factor=False)
"""P2's evident choices for the test gear: grade 5, C_a 7 um of Figure 7, no low-load stiffness factor."""
REFERENCE_OPTIONS = RatingOptions(grade=5, tip_relief=5e-6, low_load_factor=False)
"""The same for the reference gear, C_a 5 um."""
