"""Orders of torque by deviation response, held against all contacts followed over the hunting cycle."""

from rigdesign.prediction.order_motion import CycleMotion, PointOrders, exact_motion, ideal_response
from tests.builders.order import BracedCase, changed, channels, settled

TABLES = 3e-5
"""Error of an order by the contact tables of the march, per torque."""


def followed(case: BracedCase, *, march: bool) -> PointOrders:
    """Orders with all contacts followed over the hunting cycle."""
    exact = PointOrders(*case.arguments)
    motion = exact_motion(case.rig, exact.loop, exact.laws, march=march)
    exact.__dict__["solved"] = CycleMotion(motion)
    return exact


def order_errors(name, values, rpm, torque, orders, *, march, steps=(0, 30), shafts="torsional"):
    """Error by order of each number of corrections at most."""
    case = settled(changed(name, **values), rpm, torque, shafts)
    exact = followed(case, march=march)
    places = [channel for channel in channels(*orders) if channel.quantity == "torque"]
    known = {channel.name: exact.read(channel) for channel in places}
    base = ideal_response(*case.arguments)
    rows = []
    # the contact tables of the march hold the forces to 1e-4, and sidebands to 5 mN m of 200
    floor = TABLES * torque if march else 0.0
    for most in steps:
        fast = PointOrders(*case.arguments, base=base, steps=most)
        rows.append(dict.fromkeys(orders, 0.0))
        for channel in places:
            for order, value in fast.read(channel).items():
                exact_value = known[channel.name][order]
                error = max(abs(value - exact_value) - floor, 0.0) / abs(exact_value)
                rows[-1][order] = max(rows[-1][order], error)
        shown = ", ".join(f"{order:g}: {error:.4f}" for order, error in rows[-1].items())
        print(f"{name} {rpm:g} rpm {torque:g} N m, {most} corrections at most: {shown}")
    return rows
