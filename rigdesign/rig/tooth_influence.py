"""Influence numbers of the gears of a rig, of the cold teeth as drawn."""

from collections.abc import Iterable
from dataclasses import dataclass, field, fields, replace
from functools import lru_cache, partial

from dynamics.contact.compliance import InterpolatedCompliance
from dynamics.gear.pair import GearPair
from dynamics.gear.pair_geometry import PairGeometry
from dynamics.influence.elastic_segment import Elastic
from dynamics.influence.gear_body import GearBody
from dynamics.influence.gear_model import GearModel
from dynamics.influence.numbers import InfluenceNumbers
from rigdesign.base.parallel import BackgroundTasks
from rigdesign.rig.influence_store import InfluenceStore, Progress, silent

INTEGRAL = 0.5
"""Radius at which a gear that is one with its shaft is held, as a share of its root radius: the shaft has the rest."""

Numbers = tuple[InfluenceNumbers, InfluenceNumbers]
Compliances = tuple[InterpolatedCompliance, InterpolatedCompliance]


@dataclass(frozen=True)
class ToothInfluence:
    """Influence numbers of gear pairs, each gear once.

    near : gears whose numbers also serve gears that differ from them in face width alone, for searches over it
    """

    store: InfluenceStore = field(default_factory=InfluenceStore.default)
    near: tuple[GearModel, ...] = ()

    def prepare(self, pairs: Iterable[GearPair], say: Progress = silent) -> None:
        """Compute what is not stored of the gears of some pairs, a gear on each core."""
        models = dict.fromkeys(self.known(gear_model(pair, index)) for pair in pairs for index in (0, 1))
        missing = [model for model in models if not self.store.file(model).exists()]
        if len(missing) < 2:
            return
        say(f"influence numbers of {len(missing)} gears: computed once, then kept")
        with BackgroundTasks([partial(self.store.compute, model) for model in missing]) as tasks:
            tasks.results()

    def of_pair(self, pair: GearPair) -> Numbers:
        """Numbers of pinion and wheel on the face positions of the contact: positive z comes into mesh last."""
        return _of_pair(self, pair)

    def compliances(self, pair: GearPair) -> Compliances:
        """Compliance of pinion and wheel in their contact."""
        return _compliances(self, pair)

    def for_widths_near(self, pairs: Iterable[GearPair]) -> "ToothInfluence":
        """The same where gears that differ from those of some pairs in face width alone take their numbers over."""
        near = dict.fromkeys(gear_model(pair, index) for pair in pairs for index in (0, 1))
        return replace(self, near=tuple(near))

    def numbers(self, model: GearModel) -> InfluenceNumbers:
        """Numbers of one gear."""
        return _numbers(self, model)

    def known(self, model: GearModel) -> GearModel:
        """The gear itself, or the one whose numbers serve it."""
        if model in self.near:
            return model
        alike = (one for one in self.near if replace(model, face_width=one.face_width) == one)
        return next(alike, model)


@lru_cache(maxsize=32)
def _numbers(influence: ToothInfluence, model: GearModel) -> InfluenceNumbers:
    known = influence.known(model)
    numbers = influence.store.numbers(known)
    return numbers if known is model else numbers.over_face_width(model.face_width)


@lru_cache(maxsize=16)
def _of_pair(influence: ToothInfluence, pair: GearPair) -> Numbers:
    pinion, wheel = (influence.numbers(gear_model(pair, index)) for index in (0, 1))
    return pinion.reversed_face(), wheel


@lru_cache(maxsize=16)
def _compliances(influence: ToothInfluence, pair: GearPair) -> Compliances:
    pinion, wheel = (
        InterpolatedCompliance.of(numbers, pair.base_helix_angle) for numbers in _of_pair(influence, pair)
    )
    return pinion, wheel


def gear_model(pair: GearPair, index: int) -> GearModel:
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
    )
