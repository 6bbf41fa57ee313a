"""Gear geometry, drivetrain dynamics, power losses and root stress. SI units in and out."""

from thermal.fe.kernel_cache import place_kernels

place_kernels()
