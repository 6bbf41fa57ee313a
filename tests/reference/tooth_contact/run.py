"""Runs the reference by hand: ``python -m tests.reference.tooth_contact.run FOLDER``, an hour or so on two cores.

Every solution becomes a file in FOLDER/records; those that are there are not solved again. ``measured.json`` in this
folder is what ``gather`` makes of them.
"""

import argparse
import json
import shutil
import subprocess
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tests.reference.tooth_contact.contact_cases import ContactCase, contact_case, solve_contact
from tests.reference.tooth_contact.deck import PENALTY
from tests.reference.tooth_contact.section import EdgeSizes

STORED = Path(__file__).parent / "measured.json"
CASES = ("uhcf", "uhcf_crowned", "fzg_c")
MESHES = {"coarse": 4.0, "standard": 2.0, "fine": 1.0}
"""Factor on the edges of ``EdgeSizes``."""
SWEEP = 12


@dataclass(frozen=True)
class Job:
    """One solution: case, name of the position, mesh, factor on the penalty."""

    case: str
    position: str
    mesh: str = "standard"
    penalty: float = 1.0

    @property
    def name(self) -> str:
        """Of its record."""
        return f"{self.case}-{self.position}-{self.mesh}-{self.penalty:g}"


def path_position(case: ContactCase, position: str) -> float:
    """Path position of pair 0 [m]: start and end of the geometric path, its middle, or steps of a twelfth of the base
    pitch from there (``sweep_-6`` .. ``sweep_5``)."""
    path = case.pair.path
    middle = 0.5 * (path.start + path.end)
    if position.startswith("sweep_"):
        return middle + int(position.removeprefix("sweep_")) * case.pair.base_pitch / SWEEP
    return {"start": path.start, "middle": middle, "end": path.end}[position]


def jobs() -> Iterator[Job]:
    """All solutions: the three positions and their convergence first, then a base pitch in steps."""
    positions = ("middle", "start", "end")
    for mesh in ("standard", "coarse"):
        yield from (Job(case, position, mesh) for case in CASES for position in positions)
    for case in ("uhcf_crowned", "fzg_c"):
        yield Job(case, "start", penalty=5.0)
        yield Job(case, "start", "fine")
    for case in ("uhcf_crowned", "fzg_c", "uhcf"):
        yield from (Job(case, f"sweep_{k}") for k in range(-SWEEP // 2, SWEEP // 2) if k)
    for case in CASES:
        yield from (
            Job(case, position, "fine") for position in positions if (case, position) not in FINE_FIRST
        )


FINE_FIRST = (("uhcf_crowned", "start"), ("fzg_c", "start"))


def solve_job(job: Job, folder: Path) -> None:
    """Solve, unless its record is there already."""
    record = folder / "records" / f"{job.name}.json"
    if record.exists():
        return
    case = contact_case(job.case)
    work = folder / "work" / job.name
    sizes = EdgeSizes().scaled(MESHES[job.mesh])
    try:
        found = solve_contact(
            case, path_position(case, job.position), sizes, work, penalty=job.penalty * PENALTY
        )
    except RuntimeError as error:
        print(f"{job.name}: {error}", flush=True)
        return
    record.parent.mkdir(parents=True, exist_ok=True)
    record.write_text(json.dumps({**job.__dict__, **found}, indent=1))
    shutil.rmtree(work)
    print(f"{job.name}: {found['seconds']:.0f} s", flush=True)


def rounded(value: object) -> object:
    """Floats to six digits."""
    if isinstance(value, dict):
        return {key: rounded(item) for key, item in value.items()}
    if isinstance(value, list):
        return [rounded(item) for item in value]
    return float(f"{value:.6g}") if isinstance(value, float | np.floating) else value


def gather(folder: Path) -> None:
    """Write ``measured.json`` from all records."""
    words = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout.split()
    cases = {}
    for name in CASES:
        case = contact_case(name)
        pair = case.pair
        cases[name] = {
            "torque": case.torque,
            "width": case.width,
            "profile_crowning": list(case.profile_crowning),
            "tip_diameters": list(pair.tip_diameters),
            "bore_diameters": list(pair.bore_diameters),
            "thickness_allowances": list(pair.thickness_allowances),
            "path": [pair.path.start, pair.path.end],
            "base_pitch": pair.base_pitch,
            "body_twist": case.body_twist,
        }
    records = [json.loads(path.read_text()) for path in sorted((folder / "records").glob("*.json"))]
    for record in records:
        record.pop("seconds")
    content = {
        "provenance": {
            "solver": f"CalculiX {words[-1]}" if words else "CalculiX",
            "elements": "CPE6, plane strain, five teeth on a full ring, bore as a rigid body",
            "contact": f"face to face, linear penalty {PENALTY:g} N/mm3, no friction, sharp tip edges",
            "material": "E 206 GPa, Poisson's ratio 0.3",
            "command": "python -m tests.reference.tooth_contact.run",
        },
        "cases": cases,
        "records": records,
    }
    STORED.write_text(json.dumps(rounded(content), indent=1) + "\n")


def main() -> None:
    """Solve what is missing on two cores, then gather."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", default="", help="part of the names of the records to solve")
    given = parser.parse_args()
    wanted = [job for job in jobs() if given.only in job.name]
    with ProcessPoolExecutor(2) as pool:
        list(pool.map(solve_job, wanted, [given.folder] * len(wanted)))
    gather(given.folder)


if __name__ == "__main__":
    main()
