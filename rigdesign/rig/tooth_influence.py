"""Influence numbers of the gears of a rig, of the cold teeth as drawn."""

from dataclasses import dataclass, field, fields

from dynamics.contact.compliance import InterpolatedCompliance
from dynamics.gear.pair import GearPair
from dynamics.gear.pair_geometry import PairGeometry
from dynamics.influence.elastic_segment import Elastic
from dynamics.influence.gear_model import GearModel
from dynamics.influence.numbers import InfluenceNumbers
from dynamics.influence.section import GearBody
from rigdesign.rig.influence_store import InfluenceStore, Progress

INTEGRAL = 0.5
"""Radius at which a gear that is one with its shaft is held, as a share of its root radius: the shaft has the rest."""


@dataclass(eq=False)
class ToothInfluence:
    """Influence numbers of gear pairs, each gear once; compared by identity."""

    store: InfluenceStore = field(default_factory=InfluenceStore.default)
    say: Progress = lambda message: None
    _found: dict[GearModel, InfluenceNumbers] = field(default_factory=dict)

    def numbers(self, model: GearModel) -> InfluenceNumbers:
        """Numbers of one gear."""
        if model not in self._found:
            self._found[model] = self.store.numbers(model, self.say)
        return self._found[model]

    def stored(self, pair: GearPair) -> bool:
        """Whether the numbers of both gears are there."""
        models = [gear_model(pair, index) for index in (0, 1)]
        return all(model in self._found or self.store.file(model).exists() for model in models)

    def of_pair(self, pair: GearPair) -> tuple[InfluenceNumbers, InfluenceNumbers]:
        """Numbers of pinion and wheel on the face positions of the contact: positive z comes into mesh last."""
        pinion, wheel = (self.numbers(gear_model(pair, index)) for index in (0, 1))
        return pinion.reversed_face(), wheel

    def compliances(self, pair: GearPair) -> tuple[InterpolatedCompliance, InterpolatedCompliance]:
        """Compliance of pinion and wheel in their contact."""
        pinion, wheel = (
            InterpolatedCompliance.of(numbers, pair.base_helix_angle) for numbers in self.of_pair(pair)
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
