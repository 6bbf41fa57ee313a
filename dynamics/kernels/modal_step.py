"""One pass over the modes of a block as vector instructions: outputs of two ports, and the modes taken over the step.

Written as vectors from the start: the compiler would sum the outputs up after every row of modes.
"""

from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

FAST = ("contract", "reassoc", "nsz", "arcp")
LANES = 8
"""Numbers in a vector."""


def _advance_modes(typing: Any, bank: Any, first: Any, groups: Any, torque_a: Any, torque_b: Any) -> Any:
    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        array, start, count, t_a, t_b = args
        data = context.make_array(signature.args[0])(context, builder, array).data
        vector, number = ir.VectorType(ir.DoubleType(), LANES), start.type

        def spread(value: Any) -> Any:
            one = builder.insert_element(
                ir.Constant(vector, ir.Undefined), value, ir.Constant(ir.IntType(32), 0)
            )
            mask = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
            return builder.shuffle_vector(one, ir.Constant(vector, ir.Undefined), mask)

        def times(a: Any, b: Any) -> Any:
            return builder.fmul(a, b, flags=FAST)

        def plus(a: Any, b: Any) -> Any:
            return builder.fadd(a, b, flags=FAST)

        push_a, push_b = spread(t_a), spread(t_b)
        sums = [
            cgutils.alloca_once_value(builder, ir.Constant(vector, [0.0] * LANES))  # type: ignore[no-untyped-call]
            for _ in range(4)
        ]
        with cgutils.for_range(builder, count, intp=number) as loop:
            group = builder.add(start, builder.mul(loop.index, ir.Constant(number, N_BANK * WIDTH)))
            for lane in range(0, WIDTH, LANES):
                rows = [
                    builder.bitcast(
                        builder.gep(data, [builder.add(group, ir.Constant(number, row * WIDTH + lane))]),
                        vector.as_pointer(),
                    )
                    for row in range(N_BANK)
                ]
                values = [builder.load(row, align=8) for row in rows]
                real, imag = values[0], values[1]
                for output, total in enumerate(sums):
                    seen = plus(times(values[8 + 2 * output], real), times(values[9 + 2 * output], imag))
                    builder.store(plus(builder.load(total), seen), total)
                pushed = [plus(times(values[4 + i], push_a), times(values[6 + i], push_b)) for i in (0, 1)]
                turned = builder.fsub(times(values[2], real), times(values[3], imag), flags=FAST)
                builder.store(plus(turned, pushed[0]), rows[0], align=8)
                turned = plus(times(values[3], real), times(values[2], imag))
                builder.store(plus(turned, pushed[1]), rows[1], align=8)
        found = []
        for total in sums:
            whole = builder.load(total)
            lanes = [builder.extract_element(whole, ir.Constant(ir.IntType(32), i)) for i in range(LANES)]
            while len(lanes) > 1:
                lanes = [plus(one, other) for one, other in zip(lanes[::2], lanes[1::2])]
            found.append(lanes[0])
        return cgutils.pack_array(builder, found)  # type: ignore[no-untyped-call]

    four = types.UniTuple(types.float64, 4)  # type: ignore[no-untyped-call]
    return four(bank, first, groups, torque_a, torque_b), codegen


def _push_modes(
    typing: Any,
    bank: Any,
    first: Any,
    table: Any,
    at: Any,
    groups: Any,
    f_0: Any,
    f_1: Any,
    f_2: Any,
    f_3: Any,
) -> Any:
    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        array, start, tabulated, begin, count, *forces = args
        data = context.make_array(signature.args[0])(context, builder, array).data
        pushes = context.make_array(signature.args[2])(context, builder, tabulated).data
        vector, number = ir.VectorType(ir.DoubleType(), LANES), start.type
        zeros = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
        nothing = ir.Constant(vector, ir.Undefined)
        spread = []
        for force in forces:
            one = builder.insert_element(nothing, force, ir.Constant(ir.IntType(32), 0))
            spread.append(builder.shuffle_vector(one, nothing, zeros))
        with cgutils.for_range(builder, count, intp=number) as loop:
            group = builder.add(start, builder.mul(loop.index, ir.Constant(number, N_BANK * WIDTH)))
            own = builder.add(begin, builder.mul(loop.index, ir.Constant(number, len(forces) * 2 * WIDTH)))
            for lane in range(0, 2 * WIDTH, LANES):
                place = builder.bitcast(
                    builder.gep(data, [builder.add(group, ir.Constant(number, lane))]), vector.as_pointer()
                )
                total = builder.load(place, align=8)
                for k, force in enumerate(spread):
                    row = builder.gep(pushes, [builder.add(own, ir.Constant(number, 2 * WIDTH * k + lane))])
                    push = builder.load(builder.bitcast(row, vector.as_pointer()), align=8)
                    total = builder.fadd(total, builder.fmul(push, force, flags=FAST), flags=FAST)
                builder.store(total, place, align=8)
        return context.get_dummy_value()

    return types.void(bank, first, table, at, groups, f_0, f_1, f_2, f_3), codegen


def _dot_modes(typing: Any, bank: Any, first: Any, table: Any, at: Any, groups: Any) -> Any:
    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        array, start, tabulated, begin, count = args
        data = context.make_array(signature.args[0])(context, builder, array).data
        rows = context.make_array(signature.args[2])(context, builder, tabulated).data
        vector, number = ir.VectorType(ir.DoubleType(), LANES), start.type
        total = cgutils.alloca_once_value(builder, ir.Constant(vector, [0.0] * LANES))  # type: ignore[no-untyped-call]
        with cgutils.for_range(builder, count, intp=number) as loop:
            group = builder.add(start, builder.mul(loop.index, ir.Constant(number, N_BANK * WIDTH)))
            own = builder.add(begin, builder.mul(loop.index, ir.Constant(number, 2 * WIDTH)))
            for lane in range(0, 2 * WIDTH, LANES):
                state, row = (
                    builder.load(
                        builder.bitcast(
                            builder.gep(one, [builder.add(place, ir.Constant(number, lane))]),
                            vector.as_pointer(),
                        ),
                        align=8,
                    )
                    for one, place in ((data, group), (rows, own))
                )
                more = builder.fmul(state, row, flags=FAST)
                builder.store(builder.fadd(builder.load(total), more, flags=FAST), total)
        whole = builder.load(total)
        found = builder.extract_element(whole, ir.Constant(ir.IntType(32), 0))
        for i in range(1, LANES):
            found = builder.fadd(
                found, builder.extract_element(whole, ir.Constant(ir.IntType(32), i)), flags=FAST
            )
        return found

    return types.float64(bank, first, table, at, groups), codegen


dot_modes: Any = intrinsic(_dot_modes)
"""dot_modes(bank, first, table, at, groups): sum of the state of some groups of the bank times a row of a table."""
push_modes: Any = intrinsic(_push_modes)
"""push_modes(bank, first, table, at, groups, f_0, f_1, f_2, f_3): add to the state of some groups of the bank what four
forces push, by ``table`` from ``at`` on: per group the state of all its modes per force."""
advance_modes: Any = intrinsic(_advance_modes)
"""advance_modes(bank, first, groups, torque_a, torque_b): take a block of the bank over a step with the torques of its
two ports at the start of it; return speed and turn of port a, speed and turn of port b that its modes give."""


# Layout of the modes of a block in the bank, see ``kernels.linear_step``.

WIDTH = 16
"""Modes in a row of the tables: a fixed number, so that the compiler makes vector instructions of a loop
over them."""
N_BANK = 16
"""Rows of WIDTH in a group of the bank, real and imaginary alternating: state, decay, push of torque a, of torque b,
speed of port a, turn of port a, speed and turn of port b."""
