"""An L-shaped housing with ribs and a floor between two chambers, meshed by gmsh and written as its file.

gmsh leaves flat cells where ribs, walls and floor meet (quality down to 0.001), as a user's mesh has them.
"""

from pathlib import Path

import gmsh

ARM, REACH, HEIGHT = 0.22, 0.40, 0.25
"""Width of the arms, reach of the L and height [m]."""

WALL, RIB = 0.012, 0.008
"""Thickness of walls and ribs [m]."""

FLOOR = (0.12, 0.13)
"""Lower and upper side of the floor between the chambers [m]."""


def write_ribbed_box(size: float, file: Path) -> None:
    """Mesh with cells of ``size`` [m]: 386,000 nodes at 6 mm, 97,000 at 10.5 mm. One body, four surfaces."""
    gmsh.initialize(argv=["gmsh"], readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        body = _solid()
        gmsh.model.addPhysicalGroup(3, [body], name="box")
        for name, faces in _faces().items():
            gmsh.model.addPhysicalGroup(2, faces, name=name)
        gmsh.option.setNumber("Mesh.MeshSizeMin", size)
        gmsh.option.setNumber("Mesh.MeshSizeMax", size)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        gmsh.write(str(file))
    finally:
        gmsh.finalize()


def _solid() -> int:
    occ = gmsh.model.occ

    def corner(off: float) -> list[tuple[int, int]]:
        long, wide, high = REACH - 2.0 * off, ARM - 2.0 * off, HEIGHT - 2.0 * off
        arms = [occ.addBox(off, off, off, *sides, high) for sides in ((long, wide), (wide, long))]
        return occ.fuse([(3, arms[0])], [(3, arms[1])])[0]

    box = occ.cut(corner(0.0), corner(WALL))[0]
    parts = []
    for k in range(5):
        along = 0.03 + 0.08 * k
        parts.append((3, occ.addBox(along, -0.02, 0.0, RIB, 0.02, ARM)))
        parts.append((3, occ.addBox(-0.02, along, 0.0, 0.02, RIB, ARM)))
    low, high = FLOOR
    parts.append((3, occ.addBox(0.5 * WALL, 0.5 * WALL, low, ARM - WALL, ARM - WALL, high - low)))
    fused = occ.fuse(box, parts)[0]
    occ.synchronize()
    assert len(fused) == 1
    return int(fused[0][1])


def _faces() -> dict[str, list[int]]:
    """Faces by name: foot, outside, the warm chamber below the floor and the cold one above it."""
    found: dict[str, list[int]] = {"foot": [], "outer": [], "chamber_warm": [], "cold": []}
    near = 1e-4
    for _, face in gmsh.model.getEntities(2):
        x0, y0, z0, x1, y1, z1 = gmsh.model.getBoundingBox(2, face)
        inside = min(x0, y0, z0) > WALL - near and max(x1, y1) < REACH - WALL + near and z1 < HEIGHT - near
        end_of_arm = any(low > ARM - near and high < ARM + near for low, high in ((x0, x1), (y0, y1)))
        if max(abs(z0), abs(z1)) < near:
            found["foot"].append(face)
        elif not inside or end_of_arm:
            found["outer"].append(face)
        else:
            middle = gmsh.model.occ.getCenterOfMass(2, face)[2]
            found["chamber_warm" if middle < 0.5 * sum(FLOOR) else "cold"].append(face)
    return found
