"""A measurement set on disk for tests, and ways to spoil it."""

from pathlib import Path

HEAD = """
schema_version = 1
title = "trial"
[data]
orders = "orders.csv"
[settings.n]
quantity = "speed"
unit = "rpm"
uncertainty = "1 rpm"
[settings.M]
quantity = "torque"
unit = "N m"
uncertainty = "0.5 N m"
[settings.T_in]
quantity = "inlet_temperature"
place = "test.gear_oil"
unit = "degC"
uncertainty = "0.3 K"
[channels.TC1]
quantity = "temperature"
place = "test.outer_warm"
unit = "degC"
uncertainty = "0.1 K"
offset_uncertainty = "0.5 K"
scale_uncertainty = 0.01
[channels.TC2]
quantity = "temperature"
place = "test"
at = ["0.120 m", "0 m", "0.280 m"]
unit = "degC"
uncertainty = "0.1 K"
[channels.P]
quantity = "motor_power"
unit = "W"
uncertainty = "5 W"
[channels.M_wheel]
quantity = "torque"
place = "wheel_side"
unit = "N m"
uncertainty = "0.05 N m"
orders = [0, 1, 99]
[channels.f1]
quantity = "natural_frequency"
place = "1"
unit = "Hz"
uncertainty = "1 Hz"
"""
SPEEDS = (4000.0, 8000.0, 12000.0)
TORQUES = (90.0, 180.0)


def truth(channel: str, speed: float, torque: float) -> float:
    """A smooth rig in the units of the file."""
    return {
        "TC1": 60.0 + 2e-3 * speed + 0.05 * torque,
        "TC2": 40.0 + 1e-3 * speed + 0.02 * torque,
        "P": 0.9 * speed + 4.0 * torque,
        "M_wheel": 1.03 * torque,
        "f1": 510.0,
    }[channel]


def order_truth(order: float, speed: float, torque: float) -> complex:
    """Complex orders of the torque."""
    return (0.5 + 0.1j) if order == 1.0 else complex(1e-2 * torque, 1e-4 * speed)


def points() -> list[tuple[str, float, float]]:
    pairs = [(speed, torque) for speed in SPEEDS for torque in TORQUES]
    return [(f"P{number:02d}", *pair) for number, pair in enumerate(pairs, start=1)]


def write_set(folder: Path, repeats: int = 2) -> Path:
    """Six points, two repeats 0.02 and 0.04 apart in every reading, and one row at standstill."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "measurement.toml").write_text(HEAD, encoding="utf-8")
    columns = ("TC1", "TC2", "P", "M_wheel")
    rows = [
        "point,repeat,n,M,T_in,TC1,TC2,P,M_wheel,f1",
        ",,rpm,N m,degC,degC,degC,W,N m,Hz",
    ]
    orders = ["point,repeat,channel,order,real,imaginary"]
    for name, speed, torque in points():
        for repeat in range(1, repeats + 1):
            shift = 0.02 * (-1) ** repeat
            cells = [f"{truth(channel, speed, torque) + shift:.4f}" for channel in columns]
            rows.append(f"{name},{repeat},{speed},{torque},140,{','.join(cells)},")
            for order in (1.0, 99.0):
                amplitude = order_truth(order, speed, torque) + shift
                orders.append(f"{name},{repeat},M_wheel,{order:g},{amplitude.real:.5f},{amplitude.imag:.5f}")
    rows.append("standstill,1,,,,,,,,510")
    (folder / "data.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    (folder / "orders.csv").write_text("\n".join(orders) + "\n", encoding="utf-8")
    return folder


def replaced(folder: Path, name: str, old: str, new: str) -> None:
    text = (folder / name).read_text(encoding="utf-8")
    assert old in text
    (folder / name).write_text(text.replace(old, new), encoding="utf-8")


def changed_column(folder: Path, name: str, change) -> None:
    """Every cell of a column of data.csv that holds something, changed as a number; a text is written as it is."""
    lines = [line.split(",") for line in (folder / "data.csv").read_text(encoding="utf-8").splitlines()]
    place = lines[0].index(name)
    for cells in lines[2:]:
        if cells[place]:
            value = change(float(cells[place]))
            cells[place] = value if isinstance(value, str) else f"{value:.6f}"
    text = "\n".join(",".join(cells) for cells in lines) + "\n"
    (folder / "data.csv").write_text(text, encoding="utf-8")
