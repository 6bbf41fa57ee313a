"""Power losses of meshes, gears in mist and oil baths, oil jets and seals."""
