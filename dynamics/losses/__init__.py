"""Power losses of meshes, gears in mist, oil jets and seals."""
