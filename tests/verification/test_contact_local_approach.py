"""Local approach of the loaded contact against a discretised half plane and a finite-element wedge."""

from math import pi, radians

import numpy as np
import pytest
from scipy.sparse.linalg import splu
from skfem import Basis, ElementQuad2, ElementVector, FacetBasis, LinearForm, MeshQuad, asm
from skfem.models.elasticity import linear_elasticity

from dynamics.kernels.loaded_contact import ContactProblem, local_approach, press_points
from dynamics.tooth.compliance import EdgeModel, LocalModel, elastic_moduli, wedge_factor
from dynamics.tooth.corner import contact_places, tip_ends
from tests.builders.loaded_mesh import equal_gears, sliced_mesh

PAIR = equal_gears()
LOAD = 3e5
"""Line load [N/m]."""


def local_at_pitch_point(softer=False, path=0.0):
    mesh = sliced_mesh(PAIR, 1)
    model = LocalModel(
        pair=PAIR, gears=mesh.gears, tips=tip_ends(PAIR), edges=EdgeModel(softer=softer), line_load=LOAD
    )
    place = contact_places(PAIR, np.array([path]))
    return model.at(place, np.array([PAIR.face_width])), mesh.gears, place


def strip_deflection(at: np.ndarray, half: float, depth: float, nu: float) -> np.ndarray:
    """Deflection of the surface at distances ``at`` of a strip of unit pressure against the point ``depth`` below each
    load, times E / (1 - nu^2); Johnson, Contact Mechanics, 2.5 and Flamant's field below the surface."""

    def log_integral(x):
        return x * np.log(np.abs(x) + 1e-300) - x

    surface = -2.0 / pi * (log_integral(at + half) - log_integral(at - half))
    # the point below sinks by -2/pi ln d, the surface by -2/pi ln r - 1/(pi (1 - nu)): Flamant, Johnson 2.2
    return surface + 2.0 * half * (2.0 / pi * np.log(depth) - 1.0 / (pi * (1.0 - nu)))


def test_pressure_and_approach_of_a_line_contact():
    """Cylinders pressed together strip by strip: Hertz pressure within 1 %, Weber's approach as well."""
    local, gears, place = local_at_pitch_point()
    radius, modulus = float(local.radius[0]), local.modulus
    width = float(np.sqrt(4.0 * LOAD * radius * modulus / pi))
    n = 201
    x = np.linspace(-1.25, 1.25, n) * width
    half = 0.5 * (x[1] - x[0])
    nu = 0.3
    compliance = np.zeros((n, n))
    for index, own in enumerate(elastic_moduli(PAIR)):
        depth = float(gears[index].depth(place.roll[index])[0])
        # the reference point sinks as under the whole load at the middle: depth >> width
        compliance += own * strip_deflection(x[:, None] - x, half, depth, nu) / (2.0 * half)
    compliance = 0.5 * (compliance + compliance.T)
    own_part = 0.5 * float(compliance[0, 0] - compliance[0, 1])  # of the diagonal, counted as local
    problem = ContactProblem(
        compliance - own_part * np.eye(n), x**2 / (2.0 * radius), np.ones(n), np.tile([own_part, 0.0], (n, 1))
    )
    solved = press_points(problem, LOAD, np.nan, np.zeros(n))
    pressure = solved.force / (2.0 * half)
    force = np.array([LOAD * PAIR.face_width])
    assert solved.status == 0
    assert pressure.max() == pytest.approx(float(local.pressure(force)[0]), rel=0.01)
    assert np.ptp(x[solved.force > 0.0]) / 2.0 + half == pytest.approx(
        float(local.half_width(force)[0]), rel=0.01
    )
    assert solved.approach == pytest.approx(local_approach(force[0], *local.law[0]), rel=0.01)


def wedge_deflections(angle, places, half_width):
    """Mean deflection of a flank under Hertzian loads at distances from the edge of a wedge held at radius 1, E = 1."""
    near = np.concatenate([place + half_width * np.linspace(-1.0, 1.0, 17) for place in places])
    radii = np.unique(np.round(np.concatenate([np.geomspace(1e-5, 1.0, 90), near[near > 1e-5]]), 9))
    turns = np.linspace(0.0, 1.0, 29) ** 2.2 * angle
    polar = MeshQuad.init_tensor(radii, turns)
    r, t = polar.p
    mesh = MeshQuad(np.array([r * np.cos(t), r * np.sin(t)]), polar.t)
    nu = 0.3
    element = ElementVector(ElementQuad2())
    basis = Basis(mesh, element, intorder=4)
    stiffness = asm(linear_elasticity(nu / ((1 + nu) * (1 - 2 * nu)), 0.5 / (1 + nu)), basis)
    flank = mesh.facets_satisfying(lambda x: np.abs(x[1]) < 1e-12, boundaries_only=True)
    held = basis.get_dofs(mesh.facets_satisfying(lambda x: np.hypot(*x) > 0.98, boundaries_only=True))
    sides = FacetBasis(mesh, element, facets=flank, intorder=8)
    loads = []
    for place in places:

        @LinearForm
        def press(v, w, place=place):
            across = (w.x[0] - place) / half_width
            return 2.0 / pi / half_width * np.sqrt(np.maximum(1.0 - across**2, 0.0)) * v[1]

        loads.append(press.assemble(sides))
    free = basis.complement_dofs(held)
    right = np.array(loads).T[free]
    factor = splu(stiffness[free][:, free].tocsc())
    return np.einsum("ik,ik->k", right, factor.solve(right)) / (1.0 - nu**2)


@pytest.mark.parametrize("angle", [90.0, 115.0])
def test_flank_near_a_tip_edge_is_softer_as_a_finite_element_wedge(angle):
    """Edge term 2 (factor - 1) ln(d / e) / pi, from thirty half-widths up to the edge itself; 3.5 % but 11 % there."""
    half = 1e-3
    places = np.array([1.02, 2.0, 4.0, 10.0, 30.0]) * half
    found = wedge_deflections(radians(angle), places, half)
    term = 2.0 / pi * (wedge_factor(radians(angle)) - 1.0) * np.log(1.0 / np.hypot(places, 0.5 * half))
    assert found - found[2] == pytest.approx(term - term[2], rel=0.12)
    assert found[0] - found[-1] > 0.5 * (term[0] - term[-1]) > 0.3


def test_wedge_factor_at_its_limits():
    assert wedge_factor(pi) == pytest.approx(1.0)
    assert wedge_factor(0.5 * pi) == pytest.approx(0.5 * pi * (0.5 / (pi / 4 + 0.5) + 0.5 / (pi / 4 - 0.5)))
    assert wedge_factor(radians(100.0)) > wedge_factor(radians(130.0)) > 1.0


def test_edge_acts_near_the_tip_only():
    middle_soft, middle_hard = (local_at_pitch_point(softer)[0].law[0, 0] for softer in (True, False))
    tip = PAIR.path.tip_end - 1e-5
    tip_soft, tip_hard = (local_at_pitch_point(softer, tip)[0].law[0, 0] for softer in (True, False))
    assert middle_soft == pytest.approx(middle_hard, rel=0.03)
    assert tip_soft > 1.1 * tip_hard


def test_approach_goes_on_straight_where_the_contact_is_too_wide_for_the_logarithm():
    local, _, _ = local_at_pitch_point()
    a, c = local.law[0]
    turn = np.exp(a / c - 1.5)
    below, at, above = (local_approach(turn * f, a, c) for f in (0.999, 1.0, 1.001))
    assert (above - at) == pytest.approx(at - below, rel=1e-2)
    assert local.half_width(np.array([turn]))[0] > 0.3 * PAIR.normal_module
