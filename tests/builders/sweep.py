"""Run-ups through a known resonance, and hammer blows, as recordings of a measurement set."""

import math
from pathlib import Path

import numpy as np
from scipy.signal import cont2discrete, lfilter

from tests.builders.measurement import replaced
from tests.builders.recording import write_recorded_set, write_recording

RATE = 4000.0
ORDER = 8.0
NATURAL = 240.0
"""Of the resonance [Hz]: order 8 meets it at 1800 rpm."""
DAMPING = 0.01
UNITS = {"M_wheel": "N m", "Tach": "V", "Hammer": "N", "Answer": "g"}
CROSSING = NATURAL / ORDER * 60.0
"""[rpm]"""


def oscillator(force: np.ndarray, natural: float = NATURAL, damping: float = DAMPING) -> np.ndarray:
    """Motion over the static one of an oscillator under a sampled force, from rest."""
    w = 2.0 * math.pi * natural
    (b,), a, _ = cont2discrete(([w**2], [1.0, 2.0 * damping * w, w**2]), 1.0 / RATE, method="foh")
    return np.asarray(lfilter(b, a, force))


def swept(start: float, end: float, seconds: float, noise: float = 0.0) -> dict[str, np.ndarray]:
    """Torque and tach while the speed goes from one to another [rpm]: mean, order 1, order 8 through its resonance."""
    time = np.arange(int(RATE * seconds)) / RATE
    phi = 2.0 * math.pi / 60.0 * (start * time + 0.5 * (end - start) / seconds * time**2) + 0.4
    torque = 100.0 + 0.5 * np.cos(phi) + 0.2 * oscillator(np.cos(ORDER * phi))
    torque = torque + noise * np.random.default_rng(7).standard_normal(time.size)
    return {"M_wheel": torque, "Tach": np.tanh(20.0 * np.sin(phi))}


def struck(blows: int = 3, seconds: float = 2.0, noise: float = 0.0) -> dict[str, np.ndarray]:
    """Hammer and accelerometer on a structure with two modes, `NATURAL` and one at 410 Hz."""
    count = int(RATE * seconds * blows)
    force = np.zeros(count)
    for blow in range(blows):
        at = int(RATE * (blow * seconds + 0.1))
        force[at : at + 4] = (0.5, 1.0, 0.6, 0.1)
    motion = oscillator(force) + 0.5 * oscillator(force, natural=410.0)
    answer = np.gradient(np.gradient(motion, 1.0 / RATE), 1.0 / RATE) / 9.80665
    answer = answer + noise * np.random.default_rng(5).standard_normal(count) * np.abs(answer).max()
    return {"Hammer": 800.0 * force, "Answer": 800.0 * answer}


CHANNEL = """
[channels.n_res]
quantity = "resonance_speed"
place = "1"
orders = [8]
torque = "100 N m"
unit = "rpm"
uncertainty = "3 rpm"
signal = "M_wheel"
search_range = ["1000 rpm", "2500 rpm"]

[channels.f_1]
quantity = "natural_frequency"
place = "2"
unit = "Hz"
uncertainty = "0.5 Hz"
signal = "Answer"
search_range = ["200 Hz", "300 Hz"]
"""
SWEEPS = """
[[data.sweeps]]
file = "up.KIND"
direction = "up"
torque = "100 N m"
speeds = ["1200 rpm", "2000 rpm"]

[[data.sweeps]]
file = "down.KIND"
direction = "down"
torque = "100 N m"
speeds = ["1200 rpm", "2000 rpm"]

[[data.impacts]]
file = "blows.KIND"
force = "Hammer"
"""


def write_swept_set(folder: Path, kind: str, seconds: float = 40.0) -> Path:
    """The recorded set with a run-up, a run-down and three blows; ``kind`` is tdms or csv."""
    write_recorded_set(folder, kind)
    replaced(folder, "measurement.toml", "[settings.n]", SWEEPS.replace("KIND", kind) + "\n[settings.n]")
    replaced(folder, "measurement.toml", "[channels.T_out]", f"{CHANNEL}\n[channels.T_out]")
    replaced(folder, "measurement.toml", "orders = [0, 1, 2]", "orders = [0, 1, 8]")
    write_recording(folder / f"up.{kind}", swept(900.0, 2700.0, seconds, 0.05), UNITS, RATE)
    write_recording(folder / f"down.{kind}", swept(2700.0, 900.0, seconds, 0.05), UNITS, RATE)
    write_recording(folder / f"blows.{kind}", struck(noise=0.002), UNITS, RATE)
    return folder
