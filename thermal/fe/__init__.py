"""Named meshes, finite-element assembly and linear solvers. No physics."""
