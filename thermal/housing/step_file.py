"""A housing drawn in CAD: one solid of a STEP file with named faces -> mesh with named surfaces.

Faces have names in the file, or rules pick them; a face without a name is refused with
everything one needs to name it. gmsh's OpenCASCADE kernel reads the file in metres, whatever its unit.
"""

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path
from types import ModuleType

import numpy as np

from thermal.fe.gmsh_session import gmsh_session
from thermal.fe.mesh import FloatArray, MeshError, NamedMesh
from thermal.housing.curving import straighten_inverted
from thermal.housing.face_rules import FaceRule
from thermal.housing.mesh_file import collected_mesh
from thermal.housing.stations import Point

# Names of the faces in a STEP file, which gmsh does not read: it knows those of products only.
#
# A STEP file (ISO 10303-21) lists its entities as ``#17 = ADVANCED_FACE('name',(bounds),#surface,sense);``. The faces
# of the closed shell of a solid come in the order in which OpenCASCADE makes them; corners and number of faces are held
# against those of the part, so that a name never lands on another face.

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
    corners, seen = [], set()
    waiting = _references(_arguments(face)[1]) if len(_arguments(face)) > 1 else []
    while waiting:
        number = waiting.pop()
        if number in seen or number not in entities:
            continue
        seen.add(number)
        kind, body = entities[number]
        parts = _arguments(body)
        if kind == "CARTESIAN_POINT":
            corners.append([float(value) for value in parts[1].strip(" ()\n").split(",")])
        elif kind == "EDGE_CURVE":
            waiting += _references(parts[1]) + _references(parts[2])
        elif kind in below:
            waiting += _references(parts[below[kind]])
    return np.array(corners, dtype=np.float64).reshape(-1, 3)


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


BODY = "housing"
"""Name of the one body."""
SAMPLES = (4, 8, 16, 32, 64)
"""Points a side of the grid on which a face is looked at, until some lie inside it."""
CORNER = 1e-4
"""Distance, relative to the size of the part, within which a corner of the file belongs to a face."""


@dataclass(frozen=True, kw_only=True)
class StepFace:
    """A face of the part, numbered from 1."""

    number: int
    kind: str
    """As gmsh names it: Plane, Cylinder, Cone, BSpline surface …"""
    centre: Point
    """Centre of area [m]."""
    area: float
    """[m2]"""
    normal: Point
    """Across the face at one of its points; either sense."""
    radius: float | None
    """Of a cylinder [m]; None for another face."""
    name: str
    """In the file; empty where it has none."""
    points: FloatArray
    """(n, 3) points of the face, edges included [m]."""

    @property
    def described(self) -> str:
        """Number, kind, place, size and direction in words."""
        text = f"face {self.number}: {self.kind.lower()} about {_millimetres(self.centre)}, {1e4 * self.area:.4g} cm2"
        if self.radius is not None:
            return f"{text}, radius {1e3 * self.radius:.4g} mm"
        return f"{text}, normal ({', '.join(f'{abs(value):.3g}' for value in self.normal)})"


@dataclass(frozen=True)
class FaceNames:
    """Surface name -> numbers of its faces, and what is wrong with it in words: all faults at once."""

    surfaces: Mapping[str, tuple[int, ...]]
    unnamed: tuple[StepFace, ...]
    doubled: tuple[str, ...]
    """A face that has two names, in words."""
    idle: tuple[str, ...]
    """A rule that picks no face, in words."""

    @property
    def complete(self) -> bool:
        """Every face has one name, and every rule a face."""
        return not (self.unnamed or self.doubled or self.idle)


@dataclass(frozen=True)
class StepPart:
    """What a STEP file holds, for a picture."""

    faces: tuple[StepFace, ...]
    names: FaceNames
    triangles: Mapping[int, FloatArray]
    """Face number -> (n, 3, 3) corners [m] of flat triangles on it."""


def read_part(path: Path, rules: Mapping[str, Sequence[FaceRule]], size: float) -> StepPart:
    """Faces of the one solid of a STEP file with triangles of about ``size`` [m], whether or not all have a name.

    rules : as of `read_step`. Raises MeshError as `read_step`, but for names.
    """
    with _part(path) as gmsh:
        faces = _faces(gmsh, path)
        gmsh.option.setNumber("Mesh.MeshSizeMax", size)
        gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 16)
        gmsh.model.mesh.generate(2)
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        place = np.zeros((int(tags.max()) + 1, 3))
        place[tags.astype(np.int64)] = coordinates.reshape(-1, 3)
        triangles = {
            tag: place[gmsh.model.mesh.getElementsByType(2, tag)[1].astype(np.int64)].reshape(-1, 3, 3)
            for _, tag in gmsh.model.getEntities(2)
        }
        return StepPart(faces, named_faces(faces, rules), triangles)


def part_size(path: Path) -> Point:
    """Lengths of the part along x, y and z [m]. Raises MeshError as `read_step`, but for names."""
    with _part(path) as gmsh:
        low, high = np.reshape(gmsh.model.getBoundingBox(3, gmsh.model.getEntities(3)[0][1]), (2, 3))
        x, y, z = (high - low).tolist()
        return x, y, z


def read_step(path: Path, rules: Mapping[str, Sequence[FaceRule]], size: float, circle: int) -> NamedMesh:
    """Mesh the one solid of a STEP file as the body ``housing``.

    rules : surface name -> rules, of which each adds faces
    size : largest element [m]; circle : elements round a full circle

    Raises MeshError naming file, place and remedy for a file that is missing, cut short or no STEP, one without a solid
    or with several, a solid that is not closed, faces without a name or with two, a rule that picks no face, and what
    gmsh cannot mesh.
    """
    with _part(path) as gmsh:
        names = named_faces(_faces(gmsh, path), rules)
        _require_all_named(path.name, names)
        for name, numbers in names.surfaces.items():
            gmsh.model.addPhysicalGroup(2, numbers, name=name)
        gmsh.model.addPhysicalGroup(3, [tag for _, tag in gmsh.model.getEntities(3)], name=BODY)
        gmsh.option.setNumber("Mesh.MeshSizeMax", size)
        gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", circle)
        try:
            gmsh.model.mesh.generate(3)
            gmsh.model.mesh.setOrder(2)
        except Exception as error:  # gmsh raises bare Exception
            raise MeshError(
                f"{path.name}: gmsh could not mesh the part: {error}; look for slivers, tiny edges and faces that run "
                "into each other, or choose another fidelity"
            ) from error
        mesh = collected_mesh(gmsh, path.name)
    return replace(mesh, points=straighten_inverted(mesh.points, mesh.cells, path.name))


def named_faces(faces: Sequence[StepFace], rules: Mapping[str, Sequence[FaceRule]]) -> FaceNames:
    """Give every face its name: that of the file, or of the rule that picks it."""
    names_of: dict[int, dict[str, None]] = {
        face.number: {face.name: None} if face.name else {} for face in faces
    }
    idle = []
    for name, face_rules in rules.items():
        for count, rule in enumerate(face_rules, 1):
            picked = [face.number for face in faces if rule.holds(face.points)]
            if not picked:
                idle.append(f"rule {count} of faces.{name} picks no face")
            for number in picked:
                names_of[number][name] = None
    surfaces: dict[str, tuple[int, ...]] = {}
    for number, names in names_of.items():
        if len(names) == 1:
            (only,) = names
            surfaces[only] = (*surfaces.get(only, ()), number)
    return FaceNames(
        surfaces=surfaces,
        unnamed=tuple(face for face in faces if not names_of[face.number]),
        doubled=tuple(
            f"{face.described} is {' and '.join(names_of[face.number])}"
            for face in faces
            if len(names_of[face.number]) > 1
        ),
        idle=tuple(idle),
    )


def _require_all_named(name: str, names: FaceNames) -> None:
    faults = [*names.idle]
    if names.doubled:
        faults.append(f"{len(names.doubled)} faces with two names: {'; '.join(names.doubled)}")
    if names.unnamed:
        listed = ", ".join(face.described for face in names.unnamed)
        faults.append(f"{len(names.unnamed)} faces without a name: {listed}")
    if faults:
        raise MeshError(
            f"{name}: {'. '.join(faults)}; name the faces in CAD like the surfaces of the box, or pick each by one "
            "rule of housing.faces: rigdesign mesh CASE --out DIR draws the part with these numbers"
        )


@contextmanager
def _part(path: Path) -> Iterator[ModuleType]:
    """A gmsh session that holds the one closed solid of the file, in metres."""
    _check_step(path)
    with gmsh_session() as gmsh:
        gmsh.option.setString("Geometry.OCCTargetUnit", "M")
        gmsh.model.add(path.stem)
        try:
            gmsh.model.occ.importShapes(str(path))
            gmsh.model.occ.synchronize()
        except Exception as error:  # gmsh raises bare Exception
            raise MeshError(
                f"{path.name}: gmsh cannot read it: {error}; export the part as STEP again"
            ) from error
        _check_solid(gmsh, path.name)
        yield gmsh


def _check_step(path: Path) -> None:
    try:
        content = path.read_bytes()
    except OSError as error:
        raise MeshError(f"{path}: {error.strerror}; correct the path of the STEP file") from error
    if not content.lstrip().startswith(b"ISO-10303-21;"):
        raise MeshError(
            f"{path.name}: does not start with ISO-10303-21; it is no STEP file: export the part as STEP"
        )
    if b"END-ISO-10303-21;" not in content[-200:]:
        raise MeshError(f"{path.name}: END-ISO-10303-21 is missing, the file is cut short; export it again")


def _check_solid(gmsh: ModuleType, name: str) -> None:
    """There is one solid, and every edge lies between two faces or is the seam of one."""
    solids, faces = gmsh.model.getEntities(3), gmsh.model.getEntities(2)
    if not solids:
        content = f"{len(faces)} faces that enclose no solid" if faces else "no solid"
        raise MeshError(f"{name}: holds {content}; close the part in CAD and export it as one solid")
    if len(solids) > 1:
        listed = []
        for solid in solids:
            place = _millimetres(gmsh.model.occ.getCenterOfMass(*solid))
            listed.append(f"{1e6 * gmsh.model.occ.getMass(*solid):.4g} cm3 about {place}")
        raise MeshError(
            f"{name}: holds {len(solids)} solids, {', '.join(listed)}; export the housing alone, its parts united"
        )
    shells = gmsh.model.getBoundary(solids, combined=False, oriented=False)
    ends = Counter(tag for face in shells for _, tag in gmsh.model.getBoundary([face], False, False))
    open_edges = [tag for tag, count in ends.items() if count < 2 and gmsh.model.occ.getMass(1, tag) > 1e-7]
    if open_edges or gmsh.model.occ.getMass(*solids[0]) <= 0.0:
        raise MeshError(
            f"{name}: the solid is not closed, {len(open_edges)} edges lie on one face only; sew the part in CAD"
        )


def _faces(gmsh: ModuleType, path: Path) -> tuple[StepFace, ...]:
    tags = [tag for _, tag in gmsh.model.getEntities(2)]
    text = path.read_text(encoding="latin-1")
    names = _file_names(gmsh, path.name, tags, listed_faces(text))
    return tuple(_face(gmsh, tag, name) for tag, name in zip(tags, names, strict=True))


def _face(gmsh: ModuleType, tag: int, name: str) -> StepFace:
    inside = _inside(gmsh, tag)
    kind = gmsh.model.getType(2, tag)
    middle = inside[len(inside) // 2]
    radius = None
    if kind == "Cylinder":
        largest, least, *_ = gmsh.model.getPrincipalCurvatures(tag, middle)
        radius = 1.0 / max(abs(float(largest[0])), abs(float(least[0])))
    places = [np.reshape(gmsh.model.getValue(2, tag, inside.ravel()), (-1, 3))]
    for _, curve in gmsh.model.getBoundary([(2, tag)], combined=False, oriented=False):
        start, end = (float(bound[0]) for bound in gmsh.model.getParametrizationBounds(1, curve))
        places.append(np.reshape(gmsh.model.getValue(1, curve, np.linspace(start, end, 9)), (-1, 3)))
    return StepFace(
        number=tag,
        kind=kind,
        centre=gmsh.model.occ.getCenterOfMass(2, tag),
        area=gmsh.model.occ.getMass(2, tag),
        normal=tuple(gmsh.model.getNormal(tag, middle).tolist()),
        radius=radius,
        name=name,
        points=np.concatenate(places),
    )


def _inside(gmsh: ModuleType, tag: int) -> FloatArray:
    """(n, 2) parameters of points inside a face: a grid over its parameters, refined until some lie on it."""
    low, high = gmsh.model.getParametrizationBounds(2, tag)
    for count in SAMPLES:
        sides = [a + (b - a) * (np.arange(count) + 0.5) / count for a, b in zip(low, high)]
        grid = np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, 2)
        inside = np.array([bool(gmsh.model.isInside(2, tag, point, True)) for point in grid])
        if np.count_nonzero(inside) >= SAMPLES[0] or (inside.any() and count == SAMPLES[-1]):
            return np.asarray(grid[inside])
    return np.asarray(grid[:1])


def _file_names(gmsh: ModuleType, name: str, tags: Sequence[int], listed: Sequence[ListedFace]) -> list[str]:
    """Name of every face in the file; MeshError where names cannot be told apart, nothing if there are none."""
    if not any(face.name for face in listed):
        return [""] * len(tags)
    corners = [face.corners for face in listed if len(face.corners)]
    bounds = np.reshape(gmsh.model.getBoundingBox(-1, -1), (2, 3))
    size = float(np.ptp(bounds, axis=0).max())
    matched = len(listed) == len(tags) and bool(corners)
    if matched:
        vertices = np.array([gmsh.model.getValue(0, tag, []) for _, tag in gmsh.model.getEntities(0)])
        scale = float(np.abs(vertices).max()) / float(np.abs(np.concatenate(corners)).max())
        matched = all(
            _lies_on(gmsh, tag, scale * face.corners, CORNER * size) for tag, face in zip(tags, listed)
        )
    if not matched:
        raise MeshError(
            f"{name}: the file names faces, but its {len(listed)} listed faces are not the {len(tags)} of the part as "
            "it is read; pick the faces by rules of housing.faces, or export the part without an assembly"
        )
    return [face.name for face in listed]


def _lies_on(gmsh: ModuleType, tag: int, corners: FloatArray, within: float) -> bool:
    """Whether corners from the file are corners of a face."""
    low, high = np.reshape(gmsh.model.getBoundingBox(2, tag), (2, 3))
    return bool(np.all((corners >= low - within) & (corners <= high + within)))


def _millimetres(place: Point) -> str:
    return f"({', '.join(f'{round(1e3 * value, 3) + 0.0:g}' for value in place)}) mm"
