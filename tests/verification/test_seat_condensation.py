"""A housing condensed to its bearing seats against a direct solution of the same forms by scikit-fem and SciPy."""

import numpy as np
import pytest
import skfem
from scipy import sparse
from scipy.sparse.linalg import splu

from dynamics.rotor.rotor_model import SEAT_DIRECTIONS
from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.rig.model import build_rig
from tests.builders.expansion import IRON, STEEL, geometry
from tests.builders.paths import CASES
from thermal import forms
from thermal.expansion.elastic import CondensedSeats, condense_seats
from thermal.fe.elements import VECTOR, FiniteElements
from thermal.housing.gearbox import build_gearbox
from thermal.housing.stations import GearboxModel

DENSITY = 7200.0


@pytest.fixture(scope="module")
def model() -> GearboxModel:
    return build_gearbox(geometry(), "quick")


def condensed(model: GearboxModel, factor: float = 1.0) -> CondensedSeats:
    iron = (factor * IRON[0], *IRON[1:])
    materials = {body: iron if body in ("housing", "field") else STEEL for body in model.mesh.bodies}
    return condense_seats(model, materials, dict.fromkeys(model.mesh.bodies, DENSITY), tolerance=1e-12)


@pytest.fixture(scope="module")
def stated(model: GearboxModel) -> CondensedSeats:
    return condensed(model)


@skfem.BilinearForm
def mass(u, v, w):
    return DENSITY * (u[0] * v[0] + u[1] * v[1] + u[2] * v[2])


def test_stiffness_and_mass_of_a_direct_solution(model: GearboxModel, stated: CondensedSeats) -> None:
    """K = (B' K_fe^-1 B)^-1 and X' M_fe X with its static shapes, all nodes of the foot and all shafts held."""
    found = stated
    elements = FiniteElements(model.mesh)
    basis = elements.bases.cells(space=VECTOR, rule=elements.shape.stiffness_rule)
    stiffness = sparse.csc_array(
        forms.elasticity.assemble(basis, **dict(zip(("lam", "mu"), forms.lame(*IRON[:2]))))
    )
    inertia = mass.assemble(basis)
    n = len(model.mesh.points)
    own = np.zeros(n, dtype=np.bool_)
    for body in ("housing", "field"):
        own[model.mesh.cells[model.mesh.bodies[body]]] = True
    own[elements.surfaces[model.foot_surface].nodes] = False
    free = np.repeat(own, 3)
    loads = []
    for bearing in model.bearings:
        facets = model.mesh.surfaces[bearing.bore_surface]
        share = np.zeros(n)
        bore = elements.surfaces[bearing.bore_surface]
        for facet, weights in zip(facets, bore.weights):
            share[facet] += weights @ bore.values
        for direction in (1, 2, 0):
            force = np.zeros((n, 3))
            force[:, direction] = share / share.sum()
            loads.append(force.ravel()[free])
    unit = np.array(loads).T
    shapes = splu(stiffness[free][:, free].tocsc()).solve(unit)
    expected = np.linalg.inv(unit.T @ shapes)
    assert found.stiffness == pytest.approx(expected, rel=1e-6, abs=1e-6 * float(np.abs(expected).max()))
    modes = shapes @ expected
    own_mass = modes.T @ (sparse.csr_array(inertia)[free][:, free] @ modes)
    assert found.mass == pytest.approx(own_mass, rel=1e-3, abs=1e-3 * float(np.abs(own_mass).max()))


@pytest.mark.slow
def test_twice_the_modulus_is_twice_the_stiffness_and_the_same_mass(
    model: GearboxModel, stated: CondensedSeats
) -> None:
    soft, stiff = stated, condensed(model, 2.0)
    assert stiff.stiffness == pytest.approx(2.0 * soft.stiffness, rel=1e-6, abs=1.0)
    assert stiff.mass == pytest.approx(soft.mass, rel=1e-6, abs=1e-6)
    assert float(np.linalg.eigvalsh(soft.mass)[0]) > 0.0


def test_the_case_gives_the_rig_its_housing() -> None:
    """Under a unit force a journal on a stiff bearing moves by the compliance of its seat."""
    case = load_case(CASES / "uhcf_prototype")
    rig = build_rig(case.with_value("gearboxes.test.housing.bearing_seats", "elastic"), "standard")
    (support,) = rig.elastic.rig.supports
    assert set(support.bearings) == {f"test.{name}" for name in case.gearboxes["test"].bearings}
    assert support.directions == 3 and SEAT_DIRECTIONS[:3] == ("u_y", "u_z", "u_x")
    assert not build_rig(case, "standard").elastic.rig.supports
    # along y the wall yields more than upwards, where the plate stands under it, and along the shafts it bends
    compliance = np.diag(np.linalg.inv(support.stiffness))
    across, upwards, along = compliance[::3], compliance[1::3], compliance[2::3]
    assert (across > 1.2 * upwards).all() and (along > across).all() and 1e9 < 1.0 / compliance.max() < 2e10


def test_a_seat_is_not_stated_twice() -> None:
    case = load_case(CASES / "uhcf_prototype").with_value("gearboxes.test.housing.bearing_seats", "elastic")
    with pytest.raises(
        CaseError, match=r"bearings\.pinion_front\.support_stiffness.*mesh of the housing.*leave it out"
    ):
        case.with_value("gearboxes.test.bearings.pinion_front.support_stiffness", "1e9 N/m")
