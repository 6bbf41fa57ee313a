"""A measurement set of one point and one channel, the motor power, with further lines of a test."""

from pathlib import Path

HEAD = """
schema_version = 1
title = "motor power"
{first}
[settings.n]
quantity = "speed"
unit = "rpm"
uncertainty = "1 rpm"
[settings.M]
quantity = "torque"
unit = "N m"
uncertainty = "1 N m"
[channels.P]
quantity = "motor_power"
unit = "W"
uncertainty = "5 W"
{last}
"""


def motor_power_set(folder: Path, *, first: str = "", last: str = "") -> Path:
    """Write it; ``first`` and ``last``: lines before and after its tables."""
    (folder / "measurement.toml").write_text(HEAD.format(first=first, last=last), encoding="utf-8")
    (folder / "data.csv").write_text("point,n,M,P\n,rpm,N m,W\nP01,1500,100,470\n", encoding="utf-8")
    return folder
