"""The standard set of limits, for a case that states none or asks for those it leaves out."""

from rigdesign.case.defaults.parts import bearing_bore
from rigdesign.case.defaults.raw_tree import RawTree
from rigdesign.case.defaults.rule import Filling, Given, around, assumed, follows

LEAST_FILM = 7e-6 / 40e-3
"""Least film over journal diameter: 7 um at 40 mm, of the size of the guide values of ISO 7902-3."""


def standard_limits(tree: RawTree) -> dict[str, dict[str, Filling]]:
    """Limits by table and key; those that need what the case lacks are None."""
    return {
        "clearances": {
            "backlash_minimum": _of_module(tree, 0.005, "um", 1e6, "0.005 modules left when hot"),
            "tip_clearance_minimum": _of_module(tree, 0.1, "mm", 1e3, "0.1 modules left when hot"),
            "bearing_clearance_minimum": _of_journal(tree, 1e-3, "1 per mille of the smallest journal"),
        },
        "temperatures": {
            "oil_outlet_maximum": assumed("110 degC", "life of the oil", "100 degC", "120 degC"),
            "bearing_film_maximum": _journal_only(tree, assumed("120 degC", "white metal; guide value of ISO 7902-3")),
            "tempering_distance_minimum": assumed("20 K", "distance to the loss of hardness", "10 K", "40 K"),
        },
        "bearing": {
            "film_thickness_minimum": _of_journal(tree, LEAST_FILM, "guide values of ISO 7902-3 grow with the journal"),
            "specific_load_maximum": _journal_only(
                tree, assumed("5 MPa", "white metal; guide value of ISO 7902-3", "5 MPa", "7 MPa")
            ),
        },
        "dynamics": {
            "dynamic_factor_maximum": assumed(1.5, "load of the test known within half", 1.3, 1.8),
            "resonance_distance_minimum": assumed(0.1, "usual separation of a held speed", 0.05, 0.2),
            "lift_off_share_maximum": assumed(0.0, "flanks stay closed in every loaded stage"),
        },
        "strength": {
            "root_safety_minimum": assumed(1.4, "a rig gear must outlive the specimens", 1.2, 1.6),
        },
        "flanks": {
            "pitting_safety_minimum": assumed(
                1.2, "as 1.4 of the root: the stress of a flank grows with the root of its load", 1.0, 1.3
            ),
            "scuffing_safety_minimum": assumed(1.5, "friction and oil test are known within a third", 1.2, 2.0),
        },
        "bought_parts": {"motor": _motor(tree)},
    }  # fmt: skip


def fill_limits(tree: RawTree) -> None:
    """Fill in the standard set, in place: all of it where there are no limits, else what is left out if asked for."""
    given = tree.root.get("limits")
    if given is None:
        tree.root["limits"] = {}
    elif not isinstance(given, dict) or tree.at("limits.standard_set") is not True:
        return
    limits = tree.root["limits"]
    for table, keys in standard_limits(tree).items():
        known = {key: value for key, value in keys.items() if value is not None}
        place = limits.setdefault(table, {}) if known else {}
        for key, value in known.items():
            if isinstance(place, dict):
                place.setdefault(key, value.as_marked() if isinstance(value, Given) else value)


def _of_module(tree: RawTree, share: float, unit: str, scale: float, reason: str) -> Filling:
    """A share of the smallest module of the rig."""
    found = [
        tree.length(f"gearboxes.{box}.meshes.{mesh}.normal_module")
        for box in tree.names("gearboxes")
        for mesh in tree.names(f"gearboxes.{box}.meshes")
    ]
    known = [module for module in found if module is not None]
    return around(scale * share * min(known), unit, reason) if known else None


def _journals(tree: RawTree) -> list[float]:
    found = [
        bearing_bore(tree, box, name)
        for box in tree.names("gearboxes")
        for name in tree.names(f"gearboxes.{box}.bearings")
        if tree.text(f"gearboxes.{box}.bearings.{name}.type") in (None, "journal")
    ]
    return [bore for bore in found if bore is not None]


def _of_journal(tree: RawTree, share: float, reason: str) -> Filling:
    journals = _journals(tree)
    return around(1e6 * share * min(journals), "um", reason, (0.7, 1.4)) if journals else None


def _journal_only(tree: RawTree, limit: Given) -> Filling:
    return limit if _journals(tree) else None


def _motor(tree: RawTree) -> Filling:
    """Drive torque against the torque limit of the motor."""
    stated = tree.text("drivetrain.motor.torque_limit")
    if stated is None:
        return None
    reason = "torque limit of the motor"
    return {
        "title": "drive torque of the motor",
        "part": "drivetrain.motor",
        "quantity": "drive_torque",
        "limit": follows(stated, reason).as_marked(),
        "source": "drivetrain.motor.torque_limit of the case",
    }
