"""Stated values of a small rig, for tests of input sheets and drawing."""

from rigdesign.case.provenance import InputRow, input_rows

RIG = {
    "gearboxes": {
        "test": {
            "title": "test gearbox",
            "role": "specimen",
            "gears": {
                "pinion": {
                    "shaft": "p1", "teeth": 99, "face_width": "7 mm", "material": "case_hardened_steel",
                    "inertia": "5.015539e-04 kg m2", "spline": {"torsional_stiffness": "1e6 N m/rad"},
                },
                "wheel": {"shaft": "w1", "teeth": 102, "face_width": "15 mm", "material": "case_hardened_steel"},
            },
            "meshes": {
                "main": {
                    "pinion": "pinion", "wheel": "wheel", "normal_module": "1 mm", "pressure_angle": "20 deg",
                    "helix_angle": "0 deg", "centre_distance": "99.5 mm",
                }
            },
            "oil": {"oil": "MIL-PRF-23699", "inlet_temperature": "140 degC", "flow": "5 l/min"},
        },
        "reference": {
            "role": "rig",
            "gears": {"pinion": {"shaft": "p2", "teeth": 99}, "wheel": {"shaft": "w2", "teeth": 102}},
            "meshes": {"main": {"pinion": "pinion", "wheel": "wheel"}},
            "oil": {"oil": "own", "inlet_temperature": "40 degC", "flow": "5 l/min"},
        },
    },
    "oils": {
        "own": {
            "title": "own oil", "kinematic_viscosity_40": "32 mm2/s", "kinematic_viscosity_100": "5.4 mm2/s",
            "density_15": "870 kg/m3",
        }
    },
    "drivetrain": {
        "torque_at": "test.pinion",
        "shafts": {
            "p1": {
                "material": "case_hardened_steel",
                "sections": [
                    {"length": "80 mm", "outer_diameter": "40 mm"},
                    {"length": "120 mm", "outer_diameter": "41.92 mm"},
                ],
                "discs": {"flange": {"position": "0 mm", "inertia": "0.0002 kg m2"}},
            }
        },
        "couplings": {
            "upper": {"shafts": ["p1", "p2"], "torsional_stiffness": "138e3 N m/rad"},
            "lower": {"shafts": ["w1", "w2"]},
        },
        "motor": {"shaft": "w2", "torque_limit": "20 N m", "inertia": "0.01 kg m2"},
        "bracing": {"mode": "torque_controlled", "shifted_gear": "reference.pinion"},
    },
    "schedule": {"test_speed": "12000 rpm", "test_torque": "180 N m"},
    "document": {"author": "A. Engineer", "project": "P 17", "number": "D-1"},
}  # fmt: skip


def rig_inputs() -> list[InputRow]:
    """As ``RunResult.inputs`` has them."""
    return list(input_rows(RIG))
