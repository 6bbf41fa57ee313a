"""The dynamic mesh law from influence numbers against the loaded contact it is made from.

The loaded contact (`dynamics.tooth.loaded_mesh`) agrees with CalculiX; the law has its teeth as springs on one shared
body instead, linear about the mean load.
"""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from dynamics.errors import DynamicsInputError
from dynamics.gear.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.tooth.compliance import InterpolatedCompliance
from dynamics.tooth.elastic_pair import ElasticPair, influence_law
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_cycle import MeshCycle
from dynamics.tooth.mesh_force import StaticCycle, static_cycle
from dynamics.tooth.mesh_laws import ContactDiscretisation, mesh_law, pair_stiffness
from tests.builders.elastic_pairs import coarse_gears, equal_helical_pair, loaded, plane_gears
from tests.builders.loaded_mesh import gap_of
from tests.reference.tooth_contact import tables
from tests.reference.tooth_contact.contact_cases import contact_case

Micro = tuple[Microgeometry, Microgeometry]


@dataclass(frozen=True, kw_only=True, eq=False)
class Example:
    pair: GearPair
    gears: tuple[InterpolatedCompliance, InterpolatedCompliance]
    micro: Micro
    force: float
    n_face: int = 1

    def law(self, **changes: object) -> MeshLaw:
        elastic = ElasticPair(pair=self.pair, gears=self.gears, force=self.force)
        return influence_law(replace(elastic, **changes), self.micro)  # type: ignore[arg-type]

    def contact(self, force: float | None = None) -> MeshCycle:
        gap = gap_of(self.pair, self.micro)
        return loaded(self.pair, self.gears, gap, self.n_face).cycle(self.force if force is None else force)


def example(name: str) -> Example:
    if name == "helical":
        pair = equal_helical_pair()
        micro = Microgeometry(profile_crowning=5e-6, lead_crowning=4e-6)
        force = 300e3 * pair.face_width
        return Example(pair=pair, gears=coarse_gears(pair), micro=(micro, micro), force=force, n_face=17)
    case = contact_case(name)
    return Example(pair=case.pair, gears=plane_gears(case.pair), micro=case.micro, force=case.force)


def at_rest(law: MeshLaw, contact: MeshCycle) -> StaticCycle:
    """The law under the same force at the same positions."""
    position = contact.points.position
    return static_cycle(law, contact.mesh_force, len(position), start=float(position[0]))


def shares(rest: StaticCycle, contact: MeshCycle) -> np.ndarray:
    """Shares of the pairs of the contact in the law, (n_positions, n_pairs)."""
    points = contact.points
    place = points.position[:, None] - points.pair.base_pitch * points.pairs
    found = np.zeros(place.shape)
    for k, row in enumerate(place):
        for j, at in enumerate(row):
            same = np.abs(rest.path[k] - at) < 1e-9
            found[k, j] = rest.load_share[k, same].sum()
    np.testing.assert_allclose(
        found.sum(axis=1), 1.0, atol=2e-3
    )  # contacts on the path against those of a phase
    return found


@pytest.mark.parametrize("name", ["uhcf", "uhcf_crowned", "fzg_c", "helical"])
def test_law_shares_and_approaches_as_the_loaded_contact(name: str) -> None:
    """Prototype's test gear at 180 N m without and with crowning, FZG-C at 302 N m, a helical pair at 300 N/mm."""
    of = example(name)
    contact = of.contact()
    rest = at_rest(of.law(), contact)
    ours = shares(rest, contact)
    assert np.abs(ours - contact.load_share).max() < 0.03
    assert ours.max() == pytest.approx(contact.load_share.max(), abs=0.015)
    assert rest.approach.mean() == pytest.approx(contact.approach.mean(), rel=0.02)
    assert np.abs(rest.approach - contact.approach).max() < 0.02 * contact.approach.mean()
    assert rest.tangent_stiffness.mean() == pytest.approx(contact.tangent_stiffness.mean(), rel=0.02)


@pytest.mark.parametrize("name", ["uhcf_crowned", "fzg_c", "helical"])
@pytest.mark.parametrize("factor", [0.6, 1.4])
def test_law_holds_at_the_loads_about_its_own(name: str, factor: float) -> None:
    of = example(name)
    contact = of.contact(factor * of.force)
    rest = at_rest(of.law(), contact)
    assert np.abs(shares(rest, contact) - contact.load_share).max() < 0.05
    assert rest.approach.mean() == pytest.approx(contact.approach.mean(), rel=0.03)
    assert rest.tangent_stiffness.mean() == pytest.approx(contact.tangent_stiffness.mean(), rel=0.05)


@pytest.mark.parametrize(
    ("name", "factor", "allowed"),
    [
        *((name, factor, 0.01) for name in ("uhcf_crowned", "fzg_c") for factor in (0.005, 0.1, 2.0)),
        ("helical", 2.0, 0.01),
        ("helical", 0.1, 0.05),  # a short patch on crowned flanks: slices of the law do not hold each other
    ],
)
def test_law_can_be_made_for_any_load(name: str, factor: float, allowed: float) -> None:
    of = example(name)
    lighter = replace(of, force=factor * of.force)
    contact = lighter.contact()
    rest = at_rest(lighter.law(), contact)
    assert rest.approach.mean() == pytest.approx(contact.approach.mean(), rel=allowed)
    assert rest.tangent_stiffness.mean() == pytest.approx(
        contact.tangent_stiffness.mean(), rel=max(0.02, allowed)
    )


@pytest.mark.parametrize("name", ["uhcf", "uhcf_crowned", "fzg_c"])
def test_largest_share_is_that_of_calculix(name: str) -> None:
    of = example(name)
    rest = static_cycle(of.law(), of.force, 64)
    assert rest.load_share.max() == pytest.approx(tables.over_path(name)[1][:, 0].max(), abs=0.03)


def test_pairs_that_deflect_alone_miss_the_sharing() -> None:
    """The analytic law leaves 0.07 of the force on other pairs at the worst place."""
    of = example("uhcf_crowned")
    contact = of.contact()
    stiffness = pair_stiffness(of.pair, of.force / of.pair.face_width)
    alone = mesh_law(of.pair, stiffness, of.micro)
    rest = at_rest(alone, contact)
    assert np.abs(shares(rest, contact) - contact.load_share).max() > 0.05


def test_tangent_keeps_the_stiffness_that_the_secant_loses() -> None:
    of = example("fzg_c")
    contact = of.contact()
    tangent, secant = (
        at_rest(of.law(linearisation=kind), contact).tangent_stiffness.mean()
        / contact.tangent_stiffness.mean()
        for kind in ("tangent", "secant")
    )
    assert tangent == pytest.approx(1.0, abs=0.01)
    assert 0.95 < secant < 0.985


def test_shared_body_is_what_one_tooth_moves_the_next_by() -> None:
    """Mean over the double contact of the influence numbers of offset 1 of both gears."""
    of = example("uhcf")
    pair, reach = of.pair, of.pair.rolling_radii
    moved = []
    for at in np.linspace(pair.path.start + pair.base_pitch, pair.path.end, 9):
        first, second = (
            np.array([0.0, -pair.base_pitch]) + at + reach[0],
            reach[1] - at + pair.base_pitch * np.arange(2),
        )
        face, number = np.zeros(2), np.arange(2)
        block = of.gears[0].matrix(first, face, -number) + of.gears[1].matrix(second, face, number)
        moved.append(block[0, 1])
    law = of.law()
    assert law.body_compliance == pytest.approx(np.mean(moved), rel=0.01)
    assert 0.3 < law.body_compliance * law.mean_stiffness < 0.5


def test_mean_stiffness_is_that_under_the_load() -> None:
    of = example("fzg_c")
    law = of.law()
    assert law.mean_stiffness == pytest.approx(of.contact().tangent_stiffness.mean(), rel=0.01)


def test_single_teeth_deviate_as_in_the_analytic_law() -> None:
    of = example("uhcf")
    pitch = tuple(1e-6 * np.sin(np.arange(of.pair.teeth[0])))
    stiff = (1.2, *np.ones(of.pair.teeth[1] - 1))
    micro = Microgeometry(pitch_deviations=pitch), Microgeometry(tooth_stiffness=stiff)
    ours, equal = replace(of, micro=micro).law(), of.law()
    analytic = mesh_law(of.pair, pair_stiffness(of.pair, 5e5), micro)
    np.testing.assert_array_equal(ours.deviation_1, analytic.deviation_1)
    np.testing.assert_array_equal(ours.scale_2, analytic.scale_2)
    np.testing.assert_array_equal(ours.stiffness, equal.stiffness)
    softer = 1.0 / equal.mean_stiffness - 1.0 / ours.mean_stiffness
    of_teeth = 1.0 / equal.mean_stiffness - equal.body_compliance
    assert softer == pytest.approx(of_teeth * (1.0 - 1.0 / np.mean(stiff)), rel=1e-6)


def test_what_cannot_be_is_refused() -> None:
    of = example("fzg_c")
    with pytest.raises(DynamicsInputError, match="force = -1"):
        of.law(force=-1.0)
    elastic = ElasticPair(pair=of.pair, gears=of.gears, force=of.force)
    with pytest.raises(DynamicsInputError, match="engagement"):
        influence_law(elastic, discretisation=ContactDiscretisation(engagement="path"))
    with pytest.raises(DynamicsInputError, match="force = 0"):
        static_cycle(of.law(), 0.0)
