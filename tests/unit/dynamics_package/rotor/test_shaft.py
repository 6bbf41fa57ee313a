import math
from collections.abc import Callable

import numpy as np
import pytest

from dynamics.rotor.shaft import (
    STEEL_DENSITY,
    STEEL_SHEAR_MODULUS,
    Disc,
    DrivetrainError,
    Section,
    Shaft,
    discretise,
    free_frequencies,
)

WAVE_SPEED = math.sqrt(STEEL_SHEAR_MODULUS / STEEL_DENSITY)


def uniform(element_length: float, discs: tuple[Disc, ...] = ()) -> Shaft:
    section = Section(length=0.4, outer_diameter=0.040)
    return Shaft(name="s", sections=(section,), discs=discs, element_length=element_length)


def test_uniform_shaft_vibrates_in_half_waves() -> None:
    expected = np.arange(1, 4) * WAVE_SPEED / (2.0 * 0.4)
    assert free_frequencies(uniform(0.001)) == pytest.approx(expected, rel=1e-4)


def test_lumped_inertia_converges_with_order_two() -> None:
    exact = 3.0 * WAVE_SPEED / 0.8
    errors = [abs(free_frequencies(uniform(h))[2] / exact - 1.0) for h in (0.02, 0.01, 0.005)]
    rates = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert rates == pytest.approx([2.0, 2.0], abs=0.02)
    # the error stated in the docstring: (omega h / c)^2 / 24
    assert errors[1] == pytest.approx((3.0 * math.pi * 0.01 / 0.4) ** 2 / 24.0, rel=0.02)


def test_hollow_shaft_has_the_same_wave_speed() -> None:
    hollow = Shaft(
        name="h",
        sections=(Section(length=0.4, outer_diameter=0.04, inner_diameter=0.03),),
        element_length=0.001,
    )
    assert free_frequencies(hollow) == pytest.approx(free_frequencies(uniform(0.001)), rel=1e-9)


def test_two_discs_on_a_light_shaft() -> None:
    light = Shaft(
        name="l",
        sections=(Section(length=0.1, outer_diameter=0.02),),
        discs=(Disc(name="a", position=0.0, inertia=0.02), Disc(name="b", position=0.1, inertia=0.05)),
    )
    stiffness = STEEL_SHEAR_MODULUS * math.pi * 0.02**4 / 32.0 / 0.1
    own = light.inertia - 0.07
    # a third of the shaft's inertia moves with each end, to first order
    a, b = 0.02 + own / 3.0, 0.05 + own / 3.0
    expected = math.sqrt(stiffness * (1.0 / a + 1.0 / b)) / (2.0 * math.pi)
    assert free_frequencies(light, count=1)[0] == pytest.approx(expected, rel=1e-3)


def test_attached_body_counts_like_a_disc() -> None:
    disc = uniform(0.01, discs=(Disc(name="d", position=0.123, inertia=1e-3),))
    assert free_frequencies(uniform(0.01), ((0.123, 1e-3),)) == pytest.approx(
        free_frequencies(disc), rel=1e-12
    )


def test_chain_keeps_inertia_and_compliance_and_places_stations_exactly() -> None:
    stepped = Shaft(
        name="s",
        sections=(Section(length=0.05, outer_diameter=0.04), Section(length=0.07, outer_diameter=0.05)),
        discs=(Disc(name="d", position=0.12, inertia=2e-4),),
    )
    chain = discretise(stepped, (0.0333, 0.1))
    assert {0.0, 0.0333, 0.05, 0.1, 0.12} <= set(np.round(chain.positions, 9))
    assert np.diff(chain.positions).max() <= 0.010 + 1e-12
    assert chain.inertia.sum() == pytest.approx(stepped.inertia, rel=1e-12)
    compliance = sum(s.length / (STEEL_SHEAR_MODULUS * s.polar_moment) for s in stepped.sections)
    assert (1.0 / chain.springs).sum() == pytest.approx(compliance, rel=1e-12)


@pytest.mark.parametrize(
    ("build", "says"),
    [
        (lambda: Section(length=0.0, outer_diameter=0.04), "section length = 0.0 m: must be above 0"),
        (lambda: Section(length=0.1, outer_diameter=0.04, inner_diameter=0.05), "inner diameter = 0.05 m"),
        (lambda: Shaft(name="s", sections=()), "shaft 's': has no section"),
        (lambda: uniform(-1.0), "element_length = -1.0"),
        (lambda: Disc(name="d", position=0.0, inertia=-1.0), "disc 'd': inertia = -1.0"),
        (lambda: uniform(0.01, discs=(Disc(name="d", position=0.5, inertia=1.0),)), "within 0 and 0.4 m"),
    ],
)
def test_impossible_shafts_are_refused(build: Callable[[], object], says: str) -> None:
    with pytest.raises(DrivetrainError) as caught:
        build()
    assert says in str(caught.value)


def test_a_coarse_shaft_lists_the_modes_that_its_nodes_have() -> None:
    """A slow rig has elements as long as its shafts."""
    assert len(free_frequencies(uniform(0.2), count=9)) == 2
    assert free_frequencies(uniform(0.2), count=9)[:1] == pytest.approx(
        free_frequencies(uniform(0.2), count=1)
    )
