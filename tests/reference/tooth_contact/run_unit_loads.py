"""Runs the unit loads by hand: ``python -m tests.reference.tooth_contact.run_unit_loads FOLDER``, some minutes."""

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np

from dynamics.gear.tooth_form import ToothForm
from tests.reference.tooth_contact.contact_cases import contact_case
from tests.reference.tooth_contact.run import rounded
from tests.reference.tooth_contact.unit_loads import COARSE, FaceGrid, UnitLoads, unit_loads

STORED = Path(__file__).parent / "unit_loads.json"
PLACES = (0.15, 0.5, 0.95)
"""Of the loads on the flank: share of the roll length from form circle to tip."""


def rolls(form: ToothForm, places: tuple[float, ...] = PLACES) -> list[float]:
    """Roll lengths of the loads [m]."""
    low = form.gear.roll_length(form.form_radius)
    return [low + share * (form.flank_tip_roll - low) for share in places]


def kept(found: UnitLoads) -> dict[str, Any]:
    """Deflections and the largest root stress of every load; the fillet in full is not stored."""
    stress = found.root_stress[:, :, 1]
    return {
        "roll": found.roll.tolist(),
        "face": found.face.tolist(),
        "deflection": found.deflection.tolist(),
        "root_stress": stress.max(axis=2).tolist(),
        "root_radius": np.hypot(*found.fillet[stress[:, 0, :, 0].argmax(axis=1)].T).tolist(),
        "nodes": found.nodes,
    }


def main() -> None:
    """Plane strain on three meshes for every gear, finite face width for one load on the FZG pinion."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    content: dict[str, Any] = {
        "provenance": "CalculiX 2.20, CPE6 and C3D15, E 206 GPa, Poisson's ratio 0.3, three teeth, bore held; "
        "python -m tests.reference.tooth_contact.run_unit_loads",
        "plane": {},
        "face_width": {},
    }
    for name in ("uhcf", "fzg_c"):
        pair = contact_case(name).pair
        for index, part in enumerate(("pinion", "wheel")):
            form, bore = ToothForm(gear=pair.gears[index]), 0.5 * pair.bore_diameters[index]
            content["plane"][f"{name}_{part}"] = {
                f"{scale:g}": kept(unit_loads(form, bore, rolls(form), folder, sizes=COARSE.scaled(scale)))
                for scale in (1.0, 0.5, 0.25)
            }
    pair = contact_case("fzg_c").pair
    form, width = ToothForm(gear=pair.gears[0]), pair.face_widths[0]
    positions = (-0.5 * width, 0.0, 0.5 * width)
    for scale, layers in ((2.5, 6), (1.6, 8)):
        face = FaceGrid(width=width, positions=positions, layers=layers)
        found = unit_loads(
            form,
            0.5 * pair.bore_diameters[0],
            rolls(form, (0.5,)),
            folder,
            sizes=COARSE.scaled(scale),
            face=face,
        )
        content["face_width"][f"fzg_c_pinion_{scale:g}_{layers}"] = kept(found)
    STORED.write_text(json.dumps(rounded(content), indent=1) + "\n")


if __name__ == "__main__":
    main()
