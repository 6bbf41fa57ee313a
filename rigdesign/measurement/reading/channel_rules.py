"""Keys of channels that only some quantities have: direction and position, order and torque, a range to search."""

from collections.abc import Iterator

from rigdesign.base import units
from rigdesign.base.errors import Fault
from rigdesign.case.faults import written
from rigdesign.measurement.places import Places
from rigdesign.measurement.quantities import CHANNELS
from rigdesign.measurement.reading.directions import REMEDY, direction_of
from rigdesign.measurement.reading.document import ChannelTable
from rigdesign.prediction.model import LATERAL_QUANTITIES, MODAL_QUANTITIES


def an(words: str) -> str:
    """The words with their article."""
    return f"an {words}" if words[0] in "aeiou" else f"a {words}"


def direction_faults(at: str, entry: ChannelTable, places: Places) -> Iterator[Fault]:
    """Direction of lateral channels, position of those on a shaft."""
    said = entry.quantity.replace("_", " ")
    lateral = entry.quantity in LATERAL_QUANTITIES
    if lateral and entry.direction is None:
        yield Fault(f"{at}.direction", "", f"{an(said)} has a direction", REMEDY)
    elif entry.direction is not None and not lateral:
        yield Fault(f"{at}.direction", written(entry.direction), f"{said} has no direction", "remove the key")
    elif entry.direction is not None:
        try:
            direction_of(entry.direction)
        except units.QuantityError as error:
            yield Fault(f"{at}.direction", written(entry.direction), error.problem, REMEDY)
    on_shaft = entry.quantity == "shaft_displacement" and entry.place in places.shafts
    if on_shaft and entry.position is None:
        yield Fault(
            f"{at}.position", "", "a probe on a shaft stands at a distance from its start",
            'write position = "50 mm", or name the bearing it sits in as its place',
        )  # fmt: skip
    elif on_shaft and entry.position is not None and entry.position > places.length(entry.place):
        yield Fault(
            f"{at}.position", units.show(entry.position, "length"), f"is beyond the end of {entry.place}",
            f"write at most {units.show(places.length(entry.place), 'length')}",
        )  # fmt: skip
    elif entry.position is not None and not on_shaft:
        yield Fault(
            f"{at}.position", units.show(entry.position, "length"), "is of a shaft displacement on a shaft",
            "remove the key, or name a shaft as its place",
        )  # fmt: skip


def modal_faults(at: str, entry: ChannelTable) -> Iterator[Fault]:
    """Order and torque of a resonance speed, and the range in which a mode is looked for."""
    said = entry.quantity.replace("_", " ")
    if entry.quantity == "resonance_speed":
        if entry.orders is None or len(entry.orders) != 1 or not entry.orders[0] > 0.0:
            given = "" if entry.orders is None else str(list(entry.orders))
            yield Fault(
                f"{at}.orders", given, "a resonance speed is where one order meets a mode",
                "write the order that was tracked, above 0, e.g. orders = [28]",
            )  # fmt: skip
        if entry.torque is None:
            yield Fault(
                f"{at}.torque", "", "teeth are as stiff as the torque of the sweep presses them together",
                'write the bracing torque of its sweeps, e.g. torque = "180 N m"',
            )  # fmt: skip
    elif entry.torque is not None:
        yield Fault(f"{at}.torque", units.show(entry.torque, "torque"), f"{said} has no torque of its own",
                    "remove the key; operating points state theirs")  # fmt: skip
    if entry.search_range is None:
        return
    if entry.quantity not in MODAL_QUANTITIES:
        yield Fault(f"{at}.search_range", "", f"{said} is not looked for", "remove the key")
        return
    try:
        low, high = (units.parse(text, CHANNELS[entry.quantity].kind) for text in entry.search_range)
    except units.QuantityError as error:
        yield Fault(f"{at}.search_range", written(", ".join(entry.search_range)), error.problem, error.remedy)
        return
    if not 0.0 <= low < high:
        yield Fault(
            f"{at}.search_range", written(", ".join(entry.search_range)), "does not ascend",
            "write the least reading, then the greatest",
        )  # fmt: skip
