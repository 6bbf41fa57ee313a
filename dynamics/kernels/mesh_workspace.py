"""Mesh workspace: the state of each mesh within a step of the march, one row of numbers, those of its law first.

It is a single flat array, ``space``, read at fixed offsets from the start of a row, so that the compiler keeps numbers
that were just written in registers. A last row belongs to the place holder for a mesh that does not exist.
"""

from dynamics.kernels.mesh_tables import N_VALUES

# compiled from sources f66db97d

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
    NET,  # force, front less back, and its derivatives over reach and rate
    NET_X,
    NET_V,
    KINKED,  # bounds of what the derivatives leave out, see kernels.contact.Pressed
    CURVED,
    GIVEN,  # part of the reach that the shared body gave where the contacts were last summed [m]
    TOOTH_SHARE,  # part of a change of the reach that the teeth took there [-]
    INVERSE,  # of the Newton matrix, four numbers
) = range(N_VALUES, N_VALUES + 22)
# of both ports, the pinion's first and the wheel's PORT further
PORT = 9
(
    SPEED,  # at the end of the step [rad/s]
    TURN,  # in the step [rad]
    TAU,  # torque at the end of the step [N m], one step earlier, two steps earlier
    OLD,
    OLDER,
    MISSING,  # torque that speed and turn do not hold yet
    REACTION,  # torque that the contacts answer where they were last summed, and its derivatives
    TANGENT_X,
    TANGENT_V,
) = range(INVERSE + 4, INVERSE + 4 + PORT)
N_SPACE = INVERSE + 4 + 2 * PORT


def port_place(port: int) -> int:
    """Return the place of a port in the mesh workspace: port 2 m is the pinion of mesh m, 2 m + 1 its wheel."""
    return port // 2 * N_SPACE + port % 2 * PORT
