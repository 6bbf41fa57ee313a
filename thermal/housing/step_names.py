"""Names of the faces in a STEP file, which gmsh does not read: it knows those of products only.

A STEP file (ISO 10303-21) lists its entities as ``#17 = ADVANCED_FACE('name',(bounds),#surface,sense);``. The faces of
the closed shell of a solid come in the order in which OpenCASCADE makes them; corners and number of faces are held
against those of the part, so that a name never lands on another face.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain

import numpy as np

from thermal.fe.mesh import FloatArray

_ENTITY = re.compile(r"#(\d+)\s*=\s*([A-Z0-9_]+)\s*\(((?:'(?:[^']|'')*+'|[^';]++)*+);")
_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_TOKEN = re.compile(r"'(?:[^']|'')*'|[(),]|[^'(),]+")
_REFERENCE = re.compile(r"#(\d+)")
SURFACE_NAME = re.compile(r"[a-z][a-z0-9_]*")
"""What counts as the name of a surface; ``NONE`` or ``Face 12`` of a CAD system does not."""


@dataclass(frozen=True)
class ListedFace:
    """A face as the file lists it."""

    name: str
    """Empty where the file has none that can be the name of a surface."""
    corners: FloatArray
    """(n, 3) in the unit of the file."""


def listed_faces(text: str) -> list[ListedFace]:
    """Faces of all solids of a STEP file in the order of their shells; empty where it has no solid."""
    text = _COMMENT.sub(" ", text)
    entities = {int(number): (kind, body.rstrip()[:-1]) for number, kind, body in _ENTITY.findall(text)}
    faces = []
    for kind, body in list(entities.values()):
        if kind in ("MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS"):
            shells = [shell for shell in _references(body) if shell in entities]
            faces += [face for shell in shells for face in _shell(entities, shell)]
    return faces


def _shell(entities: dict[int, tuple[str, str]], shell: int) -> Iterator[ListedFace]:
    kind, body = entities[shell]
    if kind == "ORIENTED_CLOSED_SHELL":
        yield from chain.from_iterable(_shell(entities, number) for number in _references(body))
        return
    for number in _references(body):
        _, face = entities.get(number, ("", ""))
        name = _arguments(face)[0].strip().strip("'")
        known = SURFACE_NAME.fullmatch(name) is not None and name != "none"
        yield ListedFace(name if known else "", _corners(entities, face))


def _corners(entities: dict[int, tuple[str, str]], face: str) -> FloatArray:
    """Vertices of the edges of a face; the references down to them are followed, never those of curves."""
    below = {
        "FACE_BOUND": 1, "FACE_OUTER_BOUND": 1, "EDGE_LOOP": 1, "ORIENTED_EDGE": 3, "VERTEX_POINT": 1,
    }  # fmt: skip
    found, seen = [], set()
    waiting = _references(_arguments(face)[1]) if len(_arguments(face)) > 1 else []
    while waiting:
        number = waiting.pop()
        if number in seen or number not in entities:
            continue
        seen.add(number)
        kind, body = entities[number]
        parts = _arguments(body)
        if kind == "CARTESIAN_POINT":
            found.append([float(value) for value in parts[1].strip(" ()\n").split(",")])
        elif kind == "EDGE_CURVE":
            waiting += _references(parts[1]) + _references(parts[2])
        elif kind in below:
            waiting += _references(parts[below[kind]])
    return np.array(found, dtype=np.float64).reshape(-1, 3)


def _references(text: str) -> list[int]:
    return [int(number) for number in _REFERENCE.findall(re.sub(r"'(?:[^']|'')*'", "", text))]


def _arguments(body: str) -> list[str]:
    """Arguments of an entity, split at the commas outside of brackets and quotes."""
    parts, depth = [""], 0
    for token in _TOKEN.findall(body):
        depth += {"(": 1, ")": -1}.get(token, 0)
        if token == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += token
    return parts
