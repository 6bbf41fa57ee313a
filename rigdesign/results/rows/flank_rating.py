"""Load capacity of the flanks as rows of the result."""

from typing import Any

from rigdesign.results.flank_rating import FlankRating
from rigdesign.results.units import MPA, ZERO


def flank_rating_row(rating: FlankRating) -> dict[str, Any]:
    """Rating of one mesh at one held stage; None for what is not rated."""
    pinion, wheel = rating.pitting or (None, None)
    contact, films = rating.contact, rating.films
    return {
        "stage": rating.stage,
        "K_H_beta": rating.factors.face_load,
        "K_H_alpha": rating.factors.transverse,
        "K_H_basis": rating.sharing_basis,
        "sigma_H_pinion_MPa": None if pinion is None else MPA * pinion.stress,
        "S_H_pinion": None if pinion is None else pinion.safety,
        "sigma_H_wheel_MPa": None if wheel is None else MPA * wheel.stress,
        "S_H_wheel": None if wheel is None else wheel.safety,
        "bulk_degC": rating.bulk_temperature - ZERO,
        "bulk_basis": rating.bulk_basis,
        "contact_degC": None if contact is None else contact.highest - ZERO,
        "contact_friction": None if contact is None else contact.friction,
        "scuffing_degC": None if rating.scuffing_temperature is None else rating.scuffing_temperature - ZERO,
        "S_B": rating.scuffing_safety,
        "film_ratio_least": None if films is None else films.least,
        "film_ratio_at": None if films is None else films.thinnest,
        "film_ratio": {}
        if films is None
        else {point: float(ratio) for point, ratio in zip(films.points, films.ratio, strict=True)},
    }
