"""Gear geometry, drivetrain dynamics, power losses and root stress. SI units in and out."""
