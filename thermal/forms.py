"""Every physical term as a weak form: what the field equations say, in scikit-fem's notation.

u is the unknown and v the test function, w holds the parameters at the quadrature points. Temperatures in K, lengths
in m. Terms that are assembled over and over have a compiled twin in thermal.fe.assembly or thermal.fe.elements; the
test of the twins, tests/verification/test_fe_against_scikit_fem.py, holds them against the forms here. A new term is
written here first, assembled on a basis of `FiniteElements.bases` and added to matrix or load.
Sources: Carslaw, Jaeger, Conduction of Heat in Solids, 2nd ed., ch. 1; Boley, Weiner, Theory of Thermal Stresses,
ch. 3.
"""

from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from skfem import BilinearForm, LinearForm
from skfem.helpers import ddot, div, dot, eye, grad, sym_grad, trace

from thermal.films.law import STEFAN_BOLTZMANN

Numbers = TypeVar("Numbers", float, NDArray[np.float64])


@BilinearForm
def conduction(u: Any, v: Any, w: Any) -> Any:
    """Conduction; conductivity [W/(m K)]. Compiled: assembly.conduction_rows."""
    return w.conductivity * dot(grad(u), grad(v))


@LinearForm
def conducted_heat(v: Any, w: Any) -> Any:
    """Heat that leaves by conduction at a temperature; conductivity [W/(m K)]. Compiled: Level.flux_load."""
    return w.conductivity * dot(grad(w.temperature), grad(v))


@BilinearForm
def conductivity_slope(u: Any, v: Any, w: Any) -> Any:
    """What a conductivity that follows the temperature adds to the Jacobian; slope dk/dT [W/(m K2)]."""
    return w.slope * u * dot(grad(w.temperature), grad(v))


@BilinearForm
def heat_capacity(u: Any, v: Any, w: Any) -> Any:
    """Heat stored; capacity rho c [J/(m3 K)]."""
    return w.capacity * u * v


@LinearForm
def volume_source(v: Any, w: Any) -> Any:
    """Heat set free in a body; source [W/m3]. Compiled: FiniteElements.body_load."""
    return w.source * v


@BilinearForm
def film(u: Any, v: Any, w: Any) -> Any:
    """Film on a surface; coefficient [W/(m2 K)]. Compiled: SurfaceElements.add_mass."""
    return w.coefficient * u * v


@LinearForm
def surface_heat(v: Any, w: Any) -> Any:
    """Heat through a surface; flux [W/m2], h (T - T_fluid) for a film. Compiled: SurfaceElements.load."""
    return w.flux * v


@LinearForm
def radiation(v: Any, w: Any) -> Any:
    """Heat radiated to large surroundings; emissivity [-]."""
    return w.emissivity * STEFAN_BOLTZMANN * (w.temperature**4 - w.surroundings**4) * v


@BilinearForm
def radiation_slope(u: Any, v: Any, w: Any) -> Any:
    """What radiation adds to the Jacobian: a film of 4 eps sigma T^3."""
    return 4.0 * w.emissivity * STEFAN_BOLTZMANN * w.temperature**3 * u * v


def lame(young: Numbers, poisson: Numbers) -> tuple[Numbers, Numbers]:
    """Lame's lam and mu [Pa] from Young's modulus [Pa] and Poisson's ratio."""
    return young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), 0.5 * young / (1.0 + poisson)


def stress(strain: Any, lam: Any, mu: Any) -> Any:
    """Stress [Pa] of an isotropic body under an elastic strain (3, 3, ...); Lame's lam and mu [Pa]."""
    return eye(lam * trace(strain), 3) + 2.0 * mu * strain


@BilinearForm
def elasticity(u: Any, v: Any, w: Any) -> Any:
    """Stiffness of an isotropic body; Lame's lam and mu [Pa]. Compiled: assembly.elasticity_rows."""
    return ddot(stress(sym_grad(u), w.lam, w.mu), sym_grad(v))


@LinearForm
def thermal_expansion(v: Any, w: Any) -> Any:
    """Forces of hindered expansion; factor alpha E / (1 - 2 nu) [Pa/K]. Compiled: assembly.expansion_load."""
    return w.factor * (w.temperature - w.reference) * div(v)
