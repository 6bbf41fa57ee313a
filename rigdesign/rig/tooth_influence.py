"""Influence numbers of the gears of a rig, of the cold teeth as drawn."""

import os
from collections.abc import Callable, Iterable
from contextlib import ExitStack
from dataclasses import dataclass, field, fields, replace
from functools import partial

from dynamics.contact.compliance import InterpolatedCompliance
from dynamics.gear.pair import GearPair
from dynamics.gear.pair_geometry import PairGeometry
from dynamics.influence.elastic_segment import Elastic
from dynamics.influence.gear_body import GearBody
from dynamics.influence.gear_model import FACE_POSITIONS, GearModel
from dynamics.influence.numbers import InfluenceNumbers
from rigdesign.base.parallel import BackgroundTasks, cores
from rigdesign.rig.influence_store import InfluenceStore, Progress, gear_words, silent
from thermal.fe.kept_results import kept

INTEGRAL = 0.5
"""Radius at which a gear that is one with its shaft is held, as a share of its root radius: the shaft has the rest."""

QUICK_POSITIONS = 7
"""Positions over the face at fidelity quick."""

NEEDED = 2.5e9
"""Memory in which the numbers of a gear are computed [bytes]."""

Count = Callable[[int, int, str], None]
Numbers = tuple[InfluenceNumbers, InfluenceNumbers]
Compliances = tuple[InterpolatedCompliance, InterpolatedCompliance]


@dataclass(frozen=True)
class ToothInfluence:
    """Influence numbers of gear pairs, each gear once.

    positions : over the face of every gear
    near : gears whose numbers also serve gears that differ from them in face width alone, for searches over it
    """

    store: InfluenceStore = field(default_factory=InfluenceStore.default)
    positions: int = FACE_POSITIONS
    near: tuple[GearModel, ...] = ()
    _found: dict[GearModel, InfluenceNumbers] = field(default_factory=dict, compare=False, repr=False)

    def prepare(self, pairs: Iterable[GearPair], say: Progress = silent, count: Count | None = None) -> None:
        """Read the numbers of the gears of some pairs and compute what is missing, as many at a time as there is room.

        In copies of this process: where a compiled library with threads of its own has run in it, GNU OpenMP ends the
        copies, and their gears are computed here, one after the other.

        count : called with gears done, gears in all and the last one, from none on; ``say`` where it is left out
        """
        models = dict.fromkeys(
            self.known(gear_model(pair, index, self.positions)) for pair in pairs for index in (0, 1)
        )
        for model in models:
            found = None if model in self._found else self.store.stored(model, say)
            if found is not None:
                self._found[model] = found
        missing = [model for model in models if model not in self._found]
        if not missing:
            return
        # what another process computes comes last: it is read then
        missing.sort(key=self.store.in_progress)
        whole, at_once = len(missing), min(_at_once(), cores())
        say(f"influence numbers of gears not yet known: {whole}, 5 to 10 s each; then kept")
        count = count or (
            lambda done, whole, last: say(f"{done} of {whole} gears, last {last}") if done else None
        )
        count(0, whole, "")
        with ExitStack() as copies:
            begun: list[BackgroundTasks[InfluenceNumbers]] = []
            for done, model in enumerate(missing):
                begun.extend(
                    copies.enter_context(BackgroundTasks([partial(self.store.compute, new)]))
                    for new in missing[len(begun) : done + at_once]
                )
                (self._found[model],) = begun[done].results()
                count(done + 1, whole, gear_words(model))

    def of_pair(self, pair: GearPair) -> Numbers:
        """Numbers of pinion and wheel on the face positions of the contact: positive z comes into mesh last."""
        return _of_pair(self, pair)

    def compliances(self, pair: GearPair) -> Compliances:
        """Compliance of pinion and wheel in their contact."""
        return _compliances(self, pair)

    def for_widths_near(self, pairs: Iterable[GearPair]) -> "ToothInfluence":
        """The same where gears that differ from those of some pairs in face width alone take their numbers over."""
        near = dict.fromkeys(gear_model(pair, index, self.positions) for pair in pairs for index in (0, 1))
        return replace(self, near=tuple(near))

    def numbers(self, model: GearModel) -> InfluenceNumbers:
        """Numbers of one gear."""
        known = self.known(model)
        if known not in self._found:
            self._found[known] = self.store.numbers(known)
        numbers = self._found[known]
        return numbers if known == model else numbers.over_face_width(model.face_width)

    def known(self, model: GearModel) -> GearModel:
        """The gear itself, or the one whose numbers serve it."""
        if model in self.near:
            return model
        alike = (one for one in self.near if replace(model, face_width=one.face_width) == one)
        return next(alike, model)


def _at_once() -> int:
    """Gears computed at a time: `NEEDED` each, in half of the memory of the machine."""
    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else NEEDED
    return max(1, int(0.5 * memory / NEEDED))


@kept
def _of_pair(influence: ToothInfluence, pair: GearPair) -> Numbers:
    pinion, wheel = (influence.numbers(gear_model(pair, index, influence.positions)) for index in (0, 1))
    return pinion.reversed_face(), wheel


@kept
def _compliances(influence: ToothInfluence, pair: GearPair) -> Compliances:
    pinion, wheel = (
        InterpolatedCompliance.of(numbers, pair.base_helix_angle) for numbers in _of_pair(influence, pair)
    )
    return pinion, wheel


def gear_model(pair: GearPair, index: int, positions: int = FACE_POSITIONS) -> GearModel:
    """Cold gear of a pair as drawn, pinion (0) or wheel (1); of a warm pair, that at its reference temperature."""
    drawn = {entry.name: getattr(pair, entry.name) for entry in fields(PairGeometry)}
    form = PairGeometry(**drawn | {"expansion": (0.0, 0.0)}).forms[index]
    bore, details = 0.5 * pair.bore_diameters[index], pair.details[index]
    held = INTEGRAL * form.root_radius
    if details.rim_thickness is not None:
        held = min(held, INTEGRAL * (form.root_radius - details.rim_thickness))
    return GearModel(
        form=form,
        body=GearBody(
            bore_radius=bore if bore > 0.0 else held,
            rim_thickness=details.rim_thickness,
            web_thickness=details.web_thickness,
        ),
        material=Elastic(young=pair.youngs_moduli[index], poisson=pair.poisson_ratios[index]),
        face_width=pair.face_widths[index],
        n_face=positions,
    )
