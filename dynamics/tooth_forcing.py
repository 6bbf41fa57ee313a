"""Forces of unequal teeth on the linear equations of the loop, class of orders by class."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dynamics.hill_system import SAME_CLASS, MeshPeriodic
from dynamics.mesh_law import MeshLaw
from dynamics.tooth_excitation import PairSensitivity, excitation, pair_sensitivity, tooth_pattern

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Integers = NDArray[np.int64]


class ToothForcing:
    """First-order forces of unequal teeth on the gears of each mesh, class by class.

    gears : (mesh, 0 pinion or 1 wheel) of the gears whose teeth are not alike
    """

    def __init__(self, laws: Sequence[MeshLaw], loop: MeshPeriodic) -> None:
        self.laws, self.loop = tuple(laws), loop
        self.gears = [
            (m, side)
            for m, law in enumerate(self.laws)
            for side in range(2)
            if _differ(*self._teeth(law, side)[1:3])
        ]
        self._sensitivities: dict[int, PairSensitivity] = {}

    def none(self, reach: int) -> Complex:
        """No forces (n_meshes, 2, 2 reach + 1)."""
        return np.zeros((len(self.laws), 2, 2 * reach + 1), complex)

    def of_class(self, residue: float, number: Integers) -> Complex:
        """Forces of all gears in a class (n_meshes, 2, n_number), two-sided [N m]."""
        forces = self.none(int(number[-1]))
        for m, side in self.gears:
            teeth = self._teeth(self.laws[m], side)[0]
            waves = np.arange(1, teeth)
            off = waves * self.loop.meshes[m] / teeth - residue
            waves = waves[np.abs(off - np.round(off)) < SAME_CLASS]
            if waves.size:
                excited = self._excitation(m, side, waves).sum(axis=1)
                forces[m] += self.loop.harmonics(excited, residue)[:, number]
        return forces

    def of_cycle(self, m: int, side: int, cells: int, number: Integers) -> Complex:
        """Forces of one gear in the classes 0, 1 / cells ... up to a half (n_classes, 2, n_number)."""
        teeth = self._teeth(self.laws[m], side)[0]
        waves = np.arange(1, teeth)
        place = waves * int(self.loop.meshes[m]) * cells // teeth % cells
        waves, place = waves[2 * place <= cells], place[2 * place <= cells]
        excited = self._excitation(m, side, waves)
        forces = np.zeros((cells // 2 + 1, 2, number.size), complex)
        values = self.loop.harmonics(excited, place[:, None] / cells)[..., number]
        np.add.at(forces, place, values.swapaxes(0, 1))
        return forces

    def _excitation(self, m: int, side: int, waves: Integers) -> Complex:
        """Torques on pinion and wheel by each wave over the teeth of a gear (2, n_waves, n) along the cell."""
        teeth, deviation, scale, offset = self._teeth(self.laws[m], side)
        pattern = tooth_pattern(deviation, scale, teeth, waves)
        return excitation(self._sensitivity(m), self.loop.ideal[m], pattern, offset)[:2]

    def _sensitivity(self, m: int) -> PairSensitivity:
        if m not in self._sensitivities:
            self._sensitivities[m] = pair_sensitivity(
                self.loop.ideal[m], self.loop.packed[m], self.loop.motions[m]
            )
        return self._sensitivities[m]

    @staticmethod
    def _teeth(law: MeshLaw, side: int) -> tuple[int, Array, Array, int]:
        """Tooth number, deviations, scales and tooth of pair 0 of a gear."""
        if side == 0:
            return law.teeth_1, law.deviation_1, law.scale_1, 0
        return law.teeth_2, law.deviation_2, law.scale_2, law.tooth_offset_2


def _differ(deviation: Array, scale: Array) -> bool:
    return bool(np.any(deviation != deviation[0]) or np.any(scale != scale[0]))
