"""A gearbox housing drawn in CAD for the tests: one chamber, blind and open bores, a foot flange, rounded edges.

front (x = 0) blind bores behind covers, rear open bores with seals; lengths in millimetres as CAD systems write them
"""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import ModuleType

from thermal.fe.gmsh_session import gmsh_session
from thermal.housing.face_rules import Box, Cylinder, FaceRule, Plane
from thermal.housing.step_file import StepFace, named_faces, read_part

MM = 1e-3
LENGTH, WIDTH, HEIGHT, SHAFT_HEIGHT = 176.0, 280.0, 220.0, 110.0
END_WALL, WALL, FLOOR, TOP = 30.0, 12.0, 15.0, 12.0
FLANGE, FLANGE_HEIGHT, ROUNDING = 20.0, 20.0, 10.0
BEARING, SEAL, BEARING_WIDTH = 15.025, 15.3, 23.0
SHAFTS = {"test_pinion": -45.75, "test_wheel": 45.75}


def draw(
    folder: Path, name: str = "housing.step", *, unit: str = "MM", solids: int = 1, opened: bool = False
) -> Path:
    """Write the part without names of faces.

    unit : of the drawing, in which its numbers are counted; solids : 2 adds a stray block
    opened : leave the top outside away
    """
    half, inner = WIDTH / 2, WIDTH / 2 - WALL
    with gmsh_session() as session:
        session.option.setString("Geometry.OCCTargetUnit", unit)
        occ = session.model.occ
        outer = [(3, occ.addBox(0, -half, 0, LENGTH, WIDTH, HEIGHT))]
        occ.synchronize()
        rounded = [
            tag for _, tag in session.model.getEntities(1)
            if _upright(session, tag)
        ]  # fmt: skip
        outer = occ.fillet([outer[0][1]], rounded, [ROUNDING])
        flange = [(3, occ.addBox(0, -half - FLANGE, 0, LENGTH, WIDTH + 2 * FLANGE, FLANGE_HEIGHT))]
        part, _ = occ.fuse(outer, flange)
        depth = HEIGHT - FLOOR - TOP
        hollow = [(3, occ.addBox(END_WALL, -inner, FLOOR, LENGTH - 2 * END_WALL, 2 * inner, depth))]
        for y in SHAFTS.values():
            for start, long, radius in (
                (END_WALL - BEARING_WIDTH, BEARING_WIDTH, BEARING),
                (LENGTH - END_WALL, BEARING_WIDTH, BEARING),
                (LENGTH - END_WALL + BEARING_WIDTH, END_WALL - BEARING_WIDTH, SEAL),
            ):
                hollow.append((3, occ.addCylinder(start, y, SHAFT_HEIGHT, long, 0, 0, radius)))
        occ.cut(part, hollow)
        if solids == 2:
            occ.addBox(2 * LENGTH, 0, 0, 10, 10, 10)
        occ.synchronize()
        if opened:
            _leave_the_top_away(session)
        file = folder / name
        session.write(str(file))
    return file


def _upright(session: ModuleType, tag: int) -> bool:
    """Whether an edge stands along z."""
    _, _, low, _, _, high = session.model.getBoundingBox(1, tag)
    return bool(high - low > 0.9 * HEIGHT)


def _leave_the_top_away(session: ModuleType) -> None:
    occ = session.model.occ
    faces = [tag for _, tag in session.model.getEntities(2)]
    top = next(tag for tag in faces if occ.getCenterOfMass(2, tag)[2] > HEIGHT - 1.0)
    occ.remove(session.model.getEntities(3))
    occ.remove([(2, top)])
    occ.synchronize()


def rules() -> dict[str, tuple[FaceRule, ...]]:
    """Surface -> the rules that pick its faces [m]."""

    def plane(axis: int, at: float, *boxes: Box) -> FaceRule:
        point, normal = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
        point[axis], normal[axis] = at * MM, 1.0
        return FaceRule((Plane(_three(point), _three(normal)), *boxes))

    inner = WIDTH / 2 - WALL
    inside = _box((END_WALL, -inner, FLOOR), (LENGTH - END_WALL, inner, HEIGHT - TOP))
    outside = {
        "outer_warm": [
            plane(1, side * (WIDTH / 2 + edge)) for side in (-1, 1) for edge in (0.0, FLANGE)
        ] + [plane(2, HEIGHT), plane(2, FLANGE_HEIGHT)] + [
            FaceRule((Cylinder(_three([x * MM, y * MM, 0.0]), (0, 0, 1), ROUNDING * MM),))
            for x in (ROUNDING, LENGTH - ROUNDING) for y in (ROUNDING - WIDTH / 2, WIDTH / 2 - ROUNDING)
        ],
        "outer_end_front": [plane(0, 0.0)],
        "outer_end_rear": [plane(0, LENGTH)],
        "housing_foot": [plane(2, 0.0)],
        "chamber_wall": [plane(1, side * inner) for side in (-1, 1)],
        "chamber_floor": [plane(2, FLOOR, inside)],
        "chamber_top": [plane(2, HEIGHT - TOP)],
        "end_wall_front": [plane(0, END_WALL), plane(0, END_WALL - BEARING_WIDTH)],
        "end_wall_rear": [plane(0, LENGTH - END_WALL), plane(0, LENGTH - END_WALL + BEARING_WIDTH)],
    }  # fmt: skip
    front = _box((0, -WIDTH, 0), (END_WALL, WIDTH, HEIGHT))
    rear = _box((LENGTH - END_WALL, -WIDTH, 0), (LENGTH, WIDTH, HEIGHT))
    for shaft, y in SHAFTS.items():
        axis = _three([0.0, y * MM, SHAFT_HEIGHT * MM])
        bore = Cylinder(axis, (1, 0, 0), BEARING * MM)
        outside[f"bearing_bore_{shaft}_front"] = [FaceRule((bore, front))]
        outside[f"bearing_bore_{shaft}_rear"] = [FaceRule((bore, rear))]
        outside[f"seal_bore_{shaft}_rear_end"] = [FaceRule((Cylinder(axis, (1, 0, 0), SEAL * MM),))]
    return {name: tuple(own) for name, own in outside.items()}


def named(file: Path, names: Mapping[str, Sequence[FaceRule]] | None = None) -> Path:
    """Write the names of the faces into a STEP file, as a CAD system does; those that ``names`` pick, or all."""
    part = read_part(file, {}, 0.05)
    found = named_faces(part.faces, rules() if names is None else names)
    by_number = {number: name for name, numbers in found.surfaces.items() for number in numbers}
    ordered = iter(_in_shell_order(part.faces, by_number))
    text = file.read_text(encoding="latin-1")
    file.write_text(re.sub(r"ADVANCED_FACE\(''", lambda _: f"ADVANCED_FACE('{next(ordered)}'", text))
    return file


def _in_shell_order(faces: Sequence[StepFace], names: Mapping[int, str]) -> list[str]:
    return [names.get(face.number, "NONE") for face in faces]


def _box(low: tuple[float, float, float], high: tuple[float, float, float]) -> Box:
    return Box(_three([value * MM for value in low]), _three([value * MM for value in high]))


def _three(values: Sequence[float]) -> tuple[float, float, float]:
    x, y, z = values
    return float(x), float(y), float(z)
