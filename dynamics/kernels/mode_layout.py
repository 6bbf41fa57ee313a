"""Layout of the modes of a block in the bank, see ``kernels.linear_step``."""

WIDTH = 16
"""Modes in a row of the tables: a fixed number, so that the compiler makes vector instructions of a loop
over them."""
N_BANK = 16
"""Rows of WIDTH in a group of the bank, real and imaginary alternating: state, decay, push of torque a, of torque b,
speed of port a, turn of port a, speed and turn of port b."""
