"""The grammar in which every equation of the program is written: what may stand there, and what is said otherwise.

Arithmetic, comparison and a fixed list of functions on named quantities, nothing else. A text is parsed, checked node
by node and rewritten into a smaller language; it is never handed to the interpreter as it came.

    sign(x) → sgn(x)      a if c else b → where(c, a, b)      max(a, b, c) → max(max(a, b), c)      pi → 3.14159…
    a < x < b → (a < x) * (x < b)      not c, c and d, c or d → where(…)      2 * (a < b) → 2 * where(a < b, 1, 0)
"""

from __future__ import annotations

import ast
import keyword
import math
import re
import threading
from collections.abc import Callable, Mapping
from functools import lru_cache, reduce
from typing import Any

import numpy as np

from ident.equations.interpolation import interpolated
from ident.errors import Unusable
from ident.words.nearest import did_you_mean

FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    "abs": np.abs,
    "clip": np.clip,
    "cos": np.cos,
    "exp": np.exp,
    "max": np.maximum,
    "min": np.minimum,
    "sgn": np.sign,
    "sin": np.sin,
    "sqrt": np.sqrt,
    "tanh": np.tanh,
    "where": np.where,
    "lag": lambda x, _T: x,
    "lag2": lambda x, _a1, _a2: x,
    "delay": lambda x, _T: x,
    "dry": lambda limit, _speed, _acceleration, _mass: 0.0 * limit,
    "lines": lambda x, *table: interpolated("lines", x, *table),
    "monotone": lambda x, *table: interpolated("monotone", x, *table),
}
"""Functions an equation may call, with their numpy meaning for signals that stand still.

Those that remember are exact for a strength of zero: `lag` is x/(T s + 1), `lag2` x/(a2 s² + a1 s + 1), `delay`
x(t − T), and `dry` the friction force that takes at most `limit`, and at most what stops `mass` within the step.
`lines(x, x1, y1, x2, y2, …)` and `monotone(…)` are tables over rising nodes: straight lines, or cubics without
overshoot (PCHIP), and straight beyond the ends.
"""

ARITHMETIC: dict[str, Any] = {"__builtins__": {}, **FUNCTIONS}
"""All that an equation which passed the grammar finds when Python carries it out."""

DYNAMIC = ("lag", "lag2", "delay", "dry")
"""The functions that remember."""

TABLES = ("lines", "monotone")
"""The functions that are given by a table: x, then two nodes or more."""

ALIASES = {"sign": "sgn"}
CONSTANTS = {"pi": math.pi}
_PARSING = threading.Lock()
TIME = "t"
"""The time since the start of the record in s."""

_ARGUMENTS = {"clip": 3, "max": 2, "min": 2, "where": 3, "lag": 2, "lag2": 3, "delay": 2, "dry": 4}
_OPERATORS = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow, ast.USub, ast.UAdd, ast.Not, ast.And, ast.Or)
_COMPARISONS = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)
_NODES = (
    ast.BinOp,
    ast.UnaryOp,
    ast.BoolOp,
    ast.Compare,
    ast.IfExp,
    ast.Call,
    ast.Name,
    ast.Load,
    ast.Constant,
    *_OPERATORS,
    *_COMPARISONS,
)
_LONGEST, _DEEPEST, _MOST = 1000, 40, 300  # of what a user writes: characters, levels, quantities and operations
_LARGEST = 1e60  # a number beyond it is no quantity of a machine
_HIGHEST = 10.0  # power
_FOREIGN = re.compile(r"[^A-Za-z0-9_ +\-*/()<>=!^.,:']")
_JOINED = re.compile(r"(?<![\w.])(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?![eE][+-]?\d)[A-Za-z_]")
_ONLY = "only numbers, names, + - * / **, comparisons and functions"


# One thread at a time parses: Python 3.11 counts the depth of all trees in one place (python/cpython#106905), and
# raises SystemError where threads take turns in the middle of one.


def tree_of(text: str) -> ast.expr:
    """The syntax of an expression; raises SyntaxError."""
    with _PARSING:
        return ast.parse(text, mode="eval").body


def statement_of(line: str) -> ast.stmt:
    """The syntax of a line of a kernel."""
    with _PARSING:
        (statement,) = ast.parse(line).body
    return statement


@lru_cache(maxsize=65_536)
def reads(node: ast.AST) -> tuple[frozenset[str], frozenset[str]]:
    """The quantities and the functions that an expression names; of a syntax tree that nobody changes any more."""
    if isinstance(node, ast.Name):
        return frozenset({node.id}), frozenset()
    names, called = set[str](), set[str]()
    for child in ast.iter_child_nodes(node):
        if isinstance(node, ast.Call) and child is node.func and isinstance(child, ast.Name):
            called.add(child.id)
            continue
        inside = reads(child)
        names |= inside[0]
        called |= inside[1]
    return frozenset(names), frozenset(called)


def parsed(text: str, first: int = 0, strict: bool = False) -> ast.expr:
    """The expression that stands in `text` from the character `first` on, as a checked tree of the smaller language.

    `strict`: also with the limits of length, depth and powers for what a user wrote. Raises Unusable that names the
    character at fault, counted from 1 in the whole text.
    """
    right = text[first:]
    start = first + len(right) - len(right.lstrip())
    if strict:
        _refuse_text(text)
    try:
        body = tree_of(right.strip())
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise _misread(text, start, error) from None
    if strict:
        _refuse_size(text, start, body)
    for node in ast.walk(body):
        fault = _fault(node) or (_excess(node) if strict else None)
        if fault:
            raise refused(start + _blamed(node), *fault)
    return ast.fix_missing_locations(_condensed(body))


def refused(character: int, what: str, remedy: str = "correct it there") -> Unusable:
    """The refusal of an equation at a character, counted from 0."""
    return Unusable("bad-equation", what, f"equation, character {character + 1}", remedy)


def _refuse_text(text: str) -> None:
    if len(text) > _LONGEST:
        raise refused(_LONGEST, f"longer than {_LONGEST} characters", "write a shorter equation")
    if foreign := _FOREIGN.search(text):
        what = f"the character {foreign[0]!a} has no meaning here"
        raise refused(foreign.start(), what, "use letters, digits and + - * / ** ( ) < > = , .")
    if joined := _JOINED.search(text):
        raise refused(joined.end() - 1, "a number runs into a name", "write an operator between them, as in 2 * w")


def _misread(text: str, start: int, error: Exception) -> Unusable:
    column, end = getattr(error, "offset", None), len(text.rstrip())
    at = min(start + column - 1, end) if column else end
    message = str(getattr(error, "msg", "")).lower()
    if not text[start:].strip():
        return refused(start, "expected an expression, found nothing", "write what the quantity is")
    if "never closed" in message:
        return refused(at, "the bracket that opens here is never closed", "close it, or take it away")
    if "unmatched" in message:
        return refused(at, "the bracket that closes here was never opened", "open it, or take it away")
    if isinstance(error, RecursionError | MemoryError) or "nested" in message:
        return refused(start, "nested too deeply", f"use at most {_DEEPEST} levels")
    found = repr(text[at : at + 12]) if at < end else "the end"
    return refused(at, f"expected a number, a name or an operator, found {found}")


def _refuse_size(text: str, start: int, body: ast.expr) -> None:
    level: list[ast.AST] = [body]
    count = depth = 0
    while level:
        count, depth = count + sum(isinstance(node, ast.expr) for node in level), depth + 1
        if depth > _DEEPEST or count > _MOST:
            at = start + getattr(level[0], "col_offset", 0)
            raise refused(min(at, len(text)), f"more than {_DEEPEST} levels or {_MOST} terms", "simplify it")
        level = [child for node in level for child in ast.iter_child_nodes(node) if isinstance(child, ast.expr)]


def _fault(node: ast.AST) -> tuple[str, ...] | None:
    """Why a node is outside the grammar and what to do about it, or None."""
    match node:
        case ast.Call():
            return _call_fault(node)
        case ast.Constant(value=value):
            return None if type(value) in (int, float) else ("only numbers",)
        case ast.Name(id=name):
            return ("a reserved word",) if keyword.iskeyword(name) or name.startswith("_") else None
        case ast.BinOp(op=ast.BitXor()):
            return "^ is no operator here", "write ** for a power"
        case ast.Compare(ops=ops) if not all(isinstance(op, _COMPARISONS) for op in ops):
            return "only < <= > >= compare here", "use one of them"
        case ast.Attribute():
            return "a quantity has no parts", "take away the point and what is behind it"
    return None if isinstance(node, _NODES) else (_ONLY,)


def _excess(node: ast.AST) -> tuple[str, ...] | None:
    """As :func:`_fault`, for numbers and powers so large that they are no physics."""
    if isinstance(node, ast.Constant) and isinstance(node.value, int | float) and abs(node.value) > _LARGEST:
        return f"a number above {_LARGEST:g}", "write a quantity of a machine"
    return _power_fault(node.right) if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow) else None


def _blamed(node: ast.AST) -> int:
    """Where in the expression a fault is best seen."""
    match node:
        case ast.BinOp(op=ast.Pow(), right=right):
            return right.col_offset
        case ast.BinOp(op=ast.BitXor(), left=inner) | ast.Attribute(value=inner) | ast.Compare(left=inner):
            return inner.end_col_offset or 0
    return int(getattr(node, "col_offset", 0))


def _call_fault(node: ast.Call) -> tuple[str, ...] | None:
    name = node.func.id if isinstance(node.func, ast.Name) else ""
    name = ALIASES.get(name, name)
    if name not in FUNCTIONS or node.keywords:
        return "unknown function", did_you_mean(name, (*FUNCTIONS, *ALIASES))
    wanted, given = _ARGUMENTS.get(name, 1), len(node.args)
    if name in TABLES:
        whole = given >= 5 and given % 2 == 1
        return None if whole else (f"{name} takes x and the pairs x1, y1, x2, y2 of its table", "give them")
    sound = given >= wanted if name in ("max", "min") else given == wanted
    return None if sound else (f"{name} takes {wanted} argument(s), not {given}", "give as many")


def _power_fault(right: ast.expr) -> tuple[str, ...] | None:
    """A power is a number, or holds a quantity; so nothing huge is computed before there is a signal."""
    sign = isinstance(right, ast.UnaryOp) and isinstance(right.op, ast.USub | ast.UAdd)
    number = right.operand if sign and isinstance(right, ast.UnaryOp) else right
    if isinstance(number, ast.Constant):
        fine = type(number.value) in (int, float) and abs(number.value) <= _HIGHEST  # type: ignore[arg-type]
    else:
        fine = isinstance(number, ast.Name)
    return None if fine else ("a power is a number up to 10 or one name", "write a smaller power, or a parameter")


# The smaller language ---------------------------------------------------------------------------------------------


def _condensed(node: ast.expr) -> ast.expr:
    """The same expression with the words of the smaller language only."""
    match node:
        case ast.Name(id=name) if name in CONSTANTS:
            return ast.Constant(CONSTANTS[name])
        case ast.BinOp(left=left, op=op, right=right):
            return ast.BinOp(_condensed(left), op, _condensed(right))
        case ast.UnaryOp(op=op, operand=operand) if not isinstance(op, ast.Not):
            return ast.UnaryOp(op, _condensed(operand))
        case ast.IfExp(test=test, body=body, orelse=other):
            return _call("where", _condition(test), _condensed(body), _condensed(other))
        case ast.Call(func=ast.Name(id="where"), args=[test, body, other]):
            return _call("where", _condition(test), _condensed(body), _condensed(other))
        case ast.Call(func=ast.Name(id=name), args=arguments):
            done = [_condensed(argument) for argument in arguments]
            if name in ("max", "min"):
                return reduce(lambda a, b: _call(name, a, b), done)
            return _call(ALIASES.get(name, name), *done)
        case ast.Compare() | ast.BoolOp() | ast.UnaryOp():
            return _truth(node)
    return node


def _condition(node: ast.expr) -> ast.expr:
    """What decides in `where`: one comparison, or a number that is not zero."""
    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        return ast.Compare(_condensed(node.left), node.ops, [_condensed(node.comparators[0])])
    return _condensed(node)


def _truth(node: ast.expr) -> ast.expr:
    """A comparison as the number 1 or 0."""
    one, zero = ast.Constant(1.0), ast.Constant(0.0)
    match node:
        case ast.UnaryOp(operand=operand):
            return _call("where", _condition(operand), zero, one)
        case ast.BoolOp(op=ast.And(), values=values):
            return reduce(lambda a, b: ast.BinOp(a, ast.Mult(), b), map(_as_truth, values))
        case ast.BoolOp(values=values):
            return reduce(lambda a, b: _call("max", a, b), map(_as_truth, values))
        case ast.Compare(left=left, ops=ops, comparators=rights):
            lefts = [left, *rights]
            each = [ast.Compare(a, [op], [b]) for a, op, b in zip(lefts, ops, rights, strict=False)]
            return reduce(lambda a, b: ast.BinOp(a, ast.Mult(), b), map(_as_truth, each))
    raise TypeError(ast.dump(node))


def _as_truth(node: ast.expr) -> ast.expr:
    return _call("where", _condition(node), ast.Constant(1.0), ast.Constant(0.0))


def _call(name: str, *arguments: ast.expr) -> ast.Call:
    return ast.Call(ast.Name(name, ast.Load()), list(arguments), [])
