"""Forces of unequal teeth on the linear equations of the loop, class of orders by class."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.mesh.law import MeshLaw, back_deviations
from dynamics.orders.hill_system import SAME_CLASS, MeshPeriodic
from dynamics.orders.tooth_excitation import PairSensitivity, excitation, pair_sensitivity, tooth_pattern

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Integers = NDArray[np.int64]
Flanks = tuple[PairSensitivity | None, PairSensitivity | None]


class ToothForcing:
    """First-order forces of unequal teeth on the gears of each mesh, class by class.

    gears : (mesh, 0 pinion or 1 wheel) of the gears whose teeth are not alike
    """

    def __init__(self, laws: Sequence[MeshLaw], loop: MeshPeriodic) -> None:
        self.laws, self.loop = tuple(laws), loop
        self.gears = [(m, side) for m, law in enumerate(self.laws) for side in range(2) if _differ(law, side)]
        self._sensitivities: dict[int, Flanks] = {}

    def none(self, reach: int) -> Complex:
        """No forces (n_meshes, k, 2 reach + 1)."""
        return np.zeros((*self.loop.inputs.shape, 2 * reach + 1), complex)

    def of_class(self, residue: float, number: Integers) -> Complex:
        """Forces of all gears in a class (n_meshes, k, n_number), two-sided [N m]."""
        forces = self.none(int(number[-1]))
        for m, side in self.gears:
            teeth = _teeth(self.laws[m], side).number
            waves = np.arange(1, teeth)
            off = waves * self.loop.meshes[m] / teeth - residue
            waves = waves[np.abs(off - np.round(off)) < SAME_CLASS]
            if waves.size:
                excited = self._excitation(m, side, waves).sum(axis=1)
                forces[m] += self.loop.harmonics(excited, residue)[:, number]
        return forces

    def of_cycle(self, m: int, side: int, cells: int, number: Integers) -> Complex:
        """Forces of one gear in the classes 0, 1 / cells ... up to a half (n_classes, k, n_number)."""
        teeth = _teeth(self.laws[m], side).number
        waves = np.arange(1, teeth)
        place = waves * int(self.loop.meshes[m]) * cells // teeth % cells
        waves, place = waves[2 * place <= cells], place[2 * place <= cells]
        excited = self._excitation(m, side, waves)
        forces = np.zeros((cells // 2 + 1, self.loop.inputs.shape[1], number.size), complex)
        values = self.loop.harmonics(excited, place[:, None] / cells)[..., number]
        np.add.at(forces, place, values.swapaxes(0, 1))
        return forces

    def _excitation(self, m: int, side: int, waves: Integers) -> Complex:
        """Torques on the inputs by each wave over the teeth of a gear (k, n_waves, n) along the cell."""
        excited = np.zeros((self.loop.inputs.shape[1], waves.size, self.loop.samples), complex)
        for back, sensitivity in enumerate(self._sensitivity(m)):
            if sensitivity is not None:
                own = _teeth(self.laws[m], side, bool(back))
                pattern = tooth_pattern(own.deviation, own.scale, own.number, waves)
                outputs = excitation(sensitivity, self.loop.ideal[m], pattern, own.first)
                excited += self.loop.on_inputs(m, outputs)
        return excited

    def _sensitivity(self, m: int) -> Flanks:
        """What the pairs of a mesh answer, front and back."""
        if m not in self._sensitivities:
            law, packed, motion = self.loop.ideal[m], self.loop.packed[m], self.loop.motions[m]
            self._sensitivities[m] = (
                pair_sensitivity(law, packed, motion),
                pair_sensitivity(law, packed, motion, back=True),
            )
        return self._sensitivities[m]


class _Teeth(NamedTuple):
    """Teeth of one gear on one flank: their number, tables of the law, and the tooth in pair 0."""

    number: int
    deviation: Array
    scale: Array
    first: int


def _teeth(law: MeshLaw, side: int, back: bool = False) -> _Teeth:
    deviations = back_deviations(law) if back else (law.deviation_1, law.deviation_2)
    if side == 0:
        return _Teeth(law.teeth_1, deviations[0], law.scale_1, 0)
    return _Teeth(law.teeth_2, deviations[1], law.scale_2, law.tooth_offset_2 + back)


def _differ(law: MeshLaw, side: int) -> bool:
    front, back = (_teeth(law, side, behind) for behind in (False, True))
    return any(bool(np.any(table != table[0])) for table in (front.deviation, back.deviation, front.scale))
