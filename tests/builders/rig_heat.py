"""Machines and room of a rig for tests."""

TRANSMISSION = """
[rig_heat.machines.transmission]
efficiency = 0.97
speed_ratio = 0.25
coolant = "warm"
coolant_share = 0.9
"""
ROOM = """
[rig_heat.room]
air_flow = "1500 m3/h"
temperature_maximum = "30 degC"
"""


def loss_map(speed: str = "15000 rpm", torque: str = "100 N m") -> str:
    """A motor with losses of 0 to 900 W up to a speed and torque."""
    points = ", ".join(
        f'{{ speed = "{at}", torque = "{load}", loss = "{loss} W" }}'
        for at, load, loss in (
            ("0 rpm", "0 N m", 0),
            ("0 rpm", torque, 300),
            (speed, "0 N m", 200),
            (speed, torque, 900),
        )
    )
    return f"\n[rig_heat.machines.motor]\nloss_map = [{points}]\n"


MAP = loss_map() + 'drives = "transmission"\n'
