"""Named meshes, finite-element assembly and linear solvers. No physics."""

from thermal.fe.kernel_cache import place_kernels

place_kernels()
