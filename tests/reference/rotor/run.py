"""Figures of ROSS for the elastic rig: `python run.py` in an environment with ross-rotordynamics writes ross.json.

Rotors are given in plain numbers, so that the tests build the same ones from the file. The frame of ROSS is (x, y, z)
with z along the shaft; ours is (y, z, x).
"""

import json
from importlib.metadata import version
from pathlib import Path

import numpy as np
import ross as rs

HERE = Path(__file__).parent
STEEL = {"density": 7810.0, "elastic_modulus": 211e9, "shear_modulus": 81.2e9}

HOLLOW = {
    # length, outer and inner diameter [m], elements
    "sections": [
        [0.12, 0.040, 0.010, 4],
        [0.20, 0.056, 0.010, 6],
        [0.15, 0.070, 0.030, 5],
        [0.18, 0.045, 0.0, 6],
    ],
    # node, mass, diametral and polar inertia
    "discs": [[7, 6.5, 0.021, 0.036], [17, 3.2, 0.0062, 0.0115]],
    # node, K (xx, xy, yx, yy), C, axial stiffness
    "bearings": [
        [2, [4.0e7, 1.2e7, -2.1e7, 6.5e7], [5.0e3, -6e2, -4e2, 8.0e3], 1e9],
        [19, [3.0e7, 0.7e7, -1.5e7, 5.0e7], [4.0e3, 3e2, 2e2, 6.5e3], 0.0],
    ],
}
SYMMETRIC = {
    **HOLLOW,
    "bearings": [
        [2, [4.0e7, 0.0, 0.0, 6.5e7], [0.0] * 4, 1e9],
        [19, [3.0e7, 0.0, 0.0, 5.0e7], [0.0] * 4, 0.0],
    ],
}


def friswell(elements: int, stiffness: list[float], damping: float = 0.0) -> dict:
    """Example 5.9.1 of Friswell et al. 2010 and its variants: two discs between two bearings at the ends."""
    third = elements // 3
    return {
        "sections": [[1.5, 0.05, 0.0, elements]],
        "discs": [[third, *disc(0.28)], [2 * third, *disc(0.35)]],
        "bearings": [
            [node, stiffness, [damping, 0.0, 0.0, damping], axial]
            for node, axial in ((0, 1e9), (elements, 0.0))
        ],
    }


def overhung(elements: int) -> dict:
    """Example 5.9.9: a disc overhung by a third of the shaft."""
    bearing = [1e7, 0.0, 0.0, 1e7]
    return {
        "sections": [[1.5, 0.05, 0.0, elements]],
        "discs": [[elements, *disc(0.35)]],
        "bearings": [[0, bearing, [0.0] * 4, 1e9], [2 * elements // 3, bearing, [0.0] * 4, 0.0]],
    }


def disc(outer: float, inner: float = 0.05, width: float = 0.07) -> list[float]:
    mass = 0.25 * np.pi * STEEL["density"] * width * (outer**2 - inner**2)
    polar = mass * (outer**2 + inner**2) / 8.0
    return [mass, 0.5 * polar + mass * width**2 / 12.0, polar]


def rotor(case: dict) -> rs.Rotor:
    material = rs.Material(
        "steel", rho=STEEL["density"], E=STEEL["elastic_modulus"], G_s=STEEL["shear_modulus"]
    )
    shaft = [
        rs.ShaftElement(length / count, inner, outer, material=material)
        for length, outer, inner, count in case["sections"]
        for _ in range(count)
    ]
    discs = [rs.DiskElement(n=n, m=m, Id=diametral, Ip=polar) for n, m, diametral, polar in case["discs"]]
    bearings = [
        rs.BearingElement(
            n=n, kxx=k[0], kxy=k[1], kyx=k[2], kyy=k[3], cxx=c[0], cxy=c[1], cyx=c[2], cyy=c[3], kzz=axial
        )
        for n, k, c, axial in case["bearings"]
    ]
    return rs.Rotor(shaft, discs, bearings)


def modes(machine: rs.Rotor, speed: float, highest: float) -> dict:
    """Poles with positive imaginary part up to a frequency [Hz]; ROSS leaves out what it takes for rigid."""
    values = machine.run_modal(speed, num_modes=2 * machine.ndof, sparse=False).evalues
    kept = values[(values.imag > 1.0) & (values.imag < 2 * np.pi * highest)]
    kept = kept[np.argsort(kept.imag)]
    return {"speed": speed, "real": kept.real.tolist(), "imag": kept.imag.tolist()}


def unbalance(machine: rs.Rotor, speeds: list[float]) -> dict:
    """Synchronous response at the first disc to 2e-4 kg m at 0.7 rad there and 1e-4 kg m at -1.1 rad on the second."""
    nodes = [int(element.n) for element in machine.disk_elements]
    answer = machine.run_unbalance_response(nodes, [2e-4, 1e-4], [0.7, -1.1], np.array(speeds)).forced_resp
    first = np.asarray(answer)[6 * nodes[0] : 6 * nodes[0] + 2]
    return {"speeds": speeds, "real": first.real.tolist(), "imag": first.imag.tolist()}


def geared() -> dict:
    """Two shafts and a spur mesh of 1e8 N/m on the line of action, wheel beside the pinion along ROSS's x axis."""
    case = {
        "sections": [[[0.30, 0.040, 0.010, 10]], [[0.24, 0.036, 0.0, 8]]],
        "gears": [[4, 2.1, 0.0020, 0.0036, 60], [5, 0.55, 0.00021, 0.00038, 30]],
        "bearings": [[0, 10, 6e7], [0, 8, 4e7]],
        "pressure_angle": float(np.radians(20.0)),
        "pitch_diameters": [0.120, 0.060],
        "mesh_stiffness": 1e8,
    }
    material = rs.Material(
        "steel", rho=STEEL["density"], E=STEEL["elastic_modulus"], G_s=STEEL["shear_modulus"]
    )
    rotors = []
    for sections, (n, m, diametral, polar, teeth), diameter, (a, b, k) in zip(
        case["sections"], case["gears"], case["pitch_diameters"], case["bearings"]
    ):
        shaft = [
            rs.ShaftElement(length / count, inner, outer, material=material)
            for length, outer, inner, count in sections
            for _ in range(count)
        ]
        gear = rs.GearElement(
            n=n, m=m, Id=diametral, Ip=polar, n_teeth=teeth, pitch_diameter=diameter,
            pr_angle=case["pressure_angle"],
        )  # fmt: skip
        bearings = [rs.BearingElement(n=a, kxx=k, cxx=3e3, kzz=1e8), rs.BearingElement(n=b, kxx=k, cxx=3e3)]
        rotors.append(rs.Rotor(shaft, [gear], bearings))
    machine = rs.MultiRotor(
        *rotors, coupled_nodes=(4, 5), gear_mesh_stiffness=case["mesh_stiffness"], orientation_angle=0.0
    )
    return {**case, "modes": [modes(machine, speed, 12e3) for speed in (0.0, 900.0)]}


def main() -> None:
    figures = {
        "peer": f"ross-rotordynamics {version('ross-rotordynamics')}",
        "steel": STEEL,
        "undamped": {**SYMMETRIC, "modes": [modes(rotor(SYMMETRIC), 0.0, 20e3)]},
        "damped": {
            **HOLLOW,
            "modes": [modes(rotor(HOLLOW), speed, 20e3) for speed in (0.0, 400.0, 1256.6)],
            "unbalance": unbalance(rotor(HOLLOW), [100.0, 400.0, 900.0, 1256.6]),
        },
        "friswell": {
            name: {
                **case,
                "modes": [modes(rotor(case), speed, 1e3) for speed in (0.0, 4000.0 * np.pi / 30.0)],
            }
            for name, case in (
                ("5.9.1", friswell(6, [1e6, 0.0, 0.0, 1e6])),
                ("5.9.2", friswell(12, [1e6, 0.0, 0.0, 8e5])),
                ("5.9.4", friswell(12, [1e6, 5e5, 0.0, 1e6])),
                ("5.9.5", friswell(6, [1e6, 0.0, 0.0, 1e6], 3e3)),
                ("5.9.9", overhung(6)),
            )
        },
        "geared": geared(),
    }
    text = json.dumps(figures, indent=1)
    (HERE / "ross.json").write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
