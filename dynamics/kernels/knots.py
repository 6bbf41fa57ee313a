"""Contraction of four rows of a table with four weights, and with four more, as vector instructions.

The compiler unrolls loops as short as these and then leaves them scalar; here the rows are vectors from the start.
"""

from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.extending import intrinsic

FAST = ("contract", "reassoc")


def _vector_at(context: Any, builder: Any, kind: Any, array: Any, place: Any, width: int) -> Any:
    """Pointer to ``width`` numbers of a contiguous array from a place on."""
    data = context.make_array(kind)(context, builder, array).data
    start = builder.gep(data, [place])
    return builder.bitcast(start, ir.VectorType(ir.DoubleType(), width).as_pointer())


def _spread(builder: Any, value: Any, width: int) -> Any:
    """A number in every element of a vector."""
    kind = ir.VectorType(ir.DoubleType(), width)
    one = builder.insert_element(ir.Constant(kind, ir.Undefined), value, ir.Constant(ir.IntType(32), 0))
    mask = ir.Constant(ir.VectorType(ir.IntType(32), width), [0] * width)
    return builder.shuffle_vector(one, ir.Constant(kind, ir.Undefined), mask)


def _contraction(width: int, sums: int, add: bool) -> Any:
    """Make the intrinsic of ``sums`` contractions of rows of ``width`` numbers."""

    def contract(typing: Any, data: Any, first: Any, stride: Any, weights: Any, out: Any, at: Any) -> Any:
        def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            table, start, step, factors, target, place = args
            rows = []
            for row in range(4):
                where = (
                    start if row == 0 else builder.add(start, builder.mul(step, ir.Constant(step.type, row)))
                )
                rows.append(
                    builder.load(
                        _vector_at(context, builder, signature.args[0], table, where, width), align=8
                    )
                )
            for part in range(sums):
                total = None
                for row in range(4):
                    factor = _spread(builder, builder.extract_value(factors, 4 * part + row), width)
                    product = builder.fmul(rows[row], factor, flags=FAST)
                    total = product if total is None else builder.fadd(total, product, flags=FAST)
                to = builder.add(place, ir.Constant(place.type, part * width))
                pointer = _vector_at(context, builder, signature.args[4], target, to, width)
                if add:
                    total = builder.fadd(total, builder.load(pointer, align=8), flags=FAST)
                builder.store(total, pointer, align=8)
            return context.get_dummy_value()

        return types.void(data, first, stride, weights, out, at), codegen

    return intrinsic(contract)


contract_cell: Any = _contraction(8, 2, add=False)
"""contract_cell(data, first, stride, weights, out, at): write 8 values and behind them 8 slopes of a cell."""
contract_lines: Any = _contraction(4, 2, add=False)
"""The same of 4 values and 4 slopes."""
contract_first: Any = _contraction(4, 1, add=False)
"""contract_first(data, first, stride, weights, out, at): write 4 values."""
add_lines: Any = _contraction(4, 1, add=True)
"""add_lines(data, first, stride, weights, out, at): add 4 values."""
