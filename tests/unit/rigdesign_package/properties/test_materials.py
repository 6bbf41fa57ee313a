"""Built-in materials stand in the ranges of the field; impossible ones are refused."""

from dataclasses import replace

import pytest

from rigdesign.properties.materials import CASE_HARDENED_STEEL, MATERIALS, Material, MaterialError


@pytest.mark.parametrize("material", list(MATERIALS.values()), ids=list(MATERIALS))
def test_built_in_materials_are_plausible(material: Material) -> None:
    assert material.source
    assert 25.0 < material.conductivity < 200.0
    assert 10e-6 < material.expansion_coefficient < 24e-6
    # velocity of sound in a bar, a number that couples E and rho: 3.8 to 5.2 km/s
    assert 3800.0 < (material.elastic_modulus / material.density) ** 0.5 < 5250.0
    # volumetric heat of solid metals, 2.4 to 3.8 MJ/(m3 K)
    assert 2.4e6 < material.density * material.heat_capacity < 3.8e6


def test_gear_steel_has_strength_and_a_tempering_temperature() -> None:
    """Sheet: sigma_FE about 0.86 to 1.0 GPa for case-hardened steel; expansion 11.5e-6."""
    steel = CASE_HARDENED_STEEL
    assert steel.root_strength is not None
    assert 860e6 <= steel.root_strength <= 1000e6
    assert steel.tempering_temperature is not None
    assert 420.0 < steel.tempering_temperature < 480.0
    assert steel.expansion_coefficient == 11.5e-6
    assert steel.shear_modulus == pytest.approx(79.2e9, rel=1e-3)
    assert all(
        material.root_strength is None
        for name, material in MATERIALS.items()
        if name != "case_hardened_steel"
    )


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"density": 0.0}, "density"),
        ({"elastic_modulus": -1.0}, "elastic_modulus"),
        ({"conductivity": 0.0}, "conductivity"),
        ({"poisson_ratio": 0.5}, "poisson_ratio"),
        ({"expansion_coefficient": 11.5}, "expansion_coefficient"),
    ],
)
def test_impossible_material(changes: dict[str, float], word: str) -> None:
    with pytest.raises(MaterialError, match=word):
        replace(CASE_HARDENED_STEEL, **changes)
