"""What a march knows of each mesh at a step: one row of numbers, the law's first.

A single array, read at fixed distances from the start of a row, is what a compiler can keep track of: a number that
was just written is still at hand. The book has a last row for the mesh that stands for none.
"""

from dynamics.kernels.contact import N_VALUES

# compiled from sources 896f0027

(
    APPROACH,  # without the imposed part, at the start of the step [m]
    ANGLE,  # of the pinion, at the start of the step [rad]
    OFFSET,  # imposed approach at the start of the step [m]
    OFFSET_RATE,
    REACH,  # approach and its rate at the end of the step, imposed ones included, moving with the torques
    RATE,
    AT_REACH,  # the same where the contacts were last summed
    AT_RATE,
    GUARD,  # distance within which kinks are looked for [m]
    CHOSEN_ANGLE,  # pinion angle, both speeds and reach at which the contacts of the step were chosen
    CHOSEN_1,
    CHOSEN_2,
    CHOSEN_REACH,
    AHEAD,  # margin of that reach [m]
    NET,  # force, front less back, and its slopes over reach and rate
    NET_X,
    NET_V,
    KINKED,  # bounds of what the slopes leave out, see kernels.contact.Pressed
    CURVED,
    INVERSE,  # of the Newton matrix, four numbers
) = range(N_VALUES, N_VALUES + 20)
# of both ports, the pinion's first and the wheel's PORT further
PORT = 9
(
    SPEED,  # at the end of the step [rad/s]
    TURN,  # in the step [rad]
    TAU,  # torque at the end of the step [N m], one step earlier, two steps earlier
    OLD,
    OLDER,
    MISSING,  # torque that speed and turn do not hold yet
    REACTION,  # torque that the contacts answer where they were last summed, and its slopes
    SLOPE_X,
    SLOPE_V,
) = range(INVERSE + 4, INVERSE + 4 + PORT)
N_BOOK = INVERSE + 4 + 2 * PORT


def port_place(port: int) -> int:
    """Return where a port stands in the flat book: port 2 m is the pinion of mesh m, 2 m + 1 its wheel."""
    return port // 2 * N_BOOK + port % 2 * PORT
