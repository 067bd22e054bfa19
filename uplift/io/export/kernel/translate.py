"""Print the kernel, functions in restricted Python, in other languages."""

from __future__ import annotations

import ast
import copy
import inspect
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import ModuleType

from uplift.io.export.kernel.intrinsics import SIZES
from uplift.io.export.kernel.language import WGSL, Language

INTRINSICS = frozenset({"number", "load_row", "tag"})
"""Functions that read the table."""
LANES = frozenset({"WIDTH", "STRIDE", "LANES"})
"""Bounds of loops that are vectorised."""
EXPANDED = frozenset({"dual"})
"""Long functions within such loops, which must be expanded there."""
BUILT_IN = frozenset({"abs", "copysign", "sqrt", "float", "int"})
OPERATORS: dict[type[ast.AST], tuple[str, int]] = {
    ast.Mult: ("*", 6),
    ast.Div: ("/", 6),
    ast.FloorDiv: ("/", 6),
    ast.Mod: ("%", 6),
    ast.Add: ("+", 5),
    ast.Sub: ("-", 5),
    ast.Lt: ("<", 4),
    ast.LtE: ("<=", 4),
    ast.Gt: (">", 4),
    ast.GtE: (">=", 4),
    ast.Eq: ("==", 4),
    ast.And: ("&&", 2),
    ast.Or: ("||", 1),
}
"""Operators with their precedence. Operands of integer division and remainder are not negative."""
UNARY, CONDITIONAL, LOWEST, CALL = 7, 0, -1, 8


def functions(*modules: ModuleType) -> list[ast.FunctionDef]:
    """Return the functions of modules of the kernel, in order."""
    return [
        statement
        for module in modules
        for statement in ast.parse(inspect.getsource(module)).body
        if isinstance(statement, ast.FunctionDef)
    ]


def translate(kernel: list[ast.FunctionDef], language: Language, name: str, constants: Mapping[str, int]) -> str:
    """Print functions in a language.

    Parameters
    ----------
    kernel : list of FunctionDef
        Functions, each after those that it calls.
    language : Language
        The language.
    name : str
        Prefix of all names.
    constants : mapping
        Integer constants, which bound the unrolled loops.

    Returns
    -------
    str
        The code.
    """
    facts: dict[str, _Facts] = {}
    for function in kernel:
        facts[function.name] = _facts(function, facts)
    unrolled = [_Unroll(constants).visit(function) for function in kernel]
    return "\n\n".join(_Printer(function, language, name, facts, constants).text() for function in unrolled) + "\n"


@dataclass(frozen=True)
class _Facts:
    """What callers must know about a function."""

    changed: tuple[bool, ...]
    """Whether each parameter is an array that the function changes."""
    reads_table: bool


LOAD_ROW = _Facts((False, True), True)


def _facts(function: ast.FunctionDef, earlier: Mapping[str, _Facts]) -> _Facts:
    changed, reads = set(), False
    for node in ast.walk(function):
        if isinstance(node, ast.Assign | ast.AugAssign):
            target = node.targets[0] if isinstance(node, ast.Assign) else node.target
            if isinstance(target, ast.Subscript) and isinstance(target.value, ast.Name):
                changed.add(target.value.id)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            called = LOAD_ROW if node.func.id == "load_row" else earlier.get(node.func.id)
            reads = reads or node.func.id in INTRINSICS or (called is not None and called.reads_table)
            if called is not None:
                for given, is_changed in zip(node.args, called.changed, strict=True):
                    if is_changed and isinstance(given, ast.Name):
                        changed.add(given.id)
    return _Facts(tuple(each.arg in changed for each in function.args.args), reads)


def _type(annotation: ast.expr | None) -> str:
    assert isinstance(annotation, ast.Name | ast.Constant)
    return "" if isinstance(annotation, ast.Constant) else annotation.id


def integer(node: ast.expr, values: Mapping[str, int]) -> int:
    """Evaluate an expression of integers; `NameError` if it has other names."""
    expression = ast.fix_missing_locations(ast.Expression(node))
    return int(eval(compile(expression, "kernel", "eval"), {"__builtins__": {}}, dict(values)))


class _Unroll(ast.NodeTransformer):
    """Replaces loops over ``unroll(start, stop)`` by their bodies, and folds the integers that result.

    Arrays that are indexed by constants only live in registers.
    """

    def __init__(self, values: Mapping[str, int]) -> None:
        self.values = values

    def visit_For(self, node: ast.For) -> ast.AST | list[ast.stmt]:
        assert isinstance(node.iter, ast.Call)
        assert isinstance(node.iter.func, ast.Name)
        assert isinstance(node.target, ast.Name)
        if node.iter.func.id != "unroll":
            return self.generic_visit(node)
        start, stop = [ast.Constant(0), *node.iter.args][-2:]
        body: list[ast.stmt] = []
        for value in range(self._integer(start), self._integer(stop)):
            inner = _Unroll({**self.values, node.target.id: value})
            for statement in node.body:
                found = inner.visit(copy.deepcopy(statement))
                body += found if isinstance(found, list) else [found]
        return body

    def visit_If(self, node: ast.If) -> ast.AST | list[ast.stmt]:
        try:
            holds = self._integer(node.test)
        except NameError:
            return self.generic_visit(node)
        return [each for statement in node.body for each in self._flat(statement)] if holds else []

    def visit_IfExp(self, node: ast.IfExp) -> ast.expr:
        try:
            chosen = node.body if self._integer(node.test) else node.orelse
        except NameError:
            self.generic_visit(node)
            return node
        found = self.visit(chosen)
        assert isinstance(found, ast.expr)
        return found

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return node if node.id.isupper() or node.id not in self.values else ast.Constant(self.values[node.id])

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        self.generic_visit(node)
        match node:
            case ast.BinOp(left=ast.Constant(value=int()), right=ast.Constant(value=int())):
                return ast.Constant(self._integer(node))
        return node

    def _flat(self, statement: ast.stmt) -> list[ast.stmt]:
        found = self.visit(statement)
        return found if isinstance(found, list) else [found]

    def _integer(self, node: ast.expr) -> int:
        return integer(node, self.values)


class _Printer:
    """Prints one function."""

    def __init__(
        self,
        function: ast.FunctionDef,
        language: Language,
        name: str,
        facts: Mapping[str, _Facts],
        constants: Mapping[str, int],
    ) -> None:
        self.function, self.language, self.name, self.facts = function, language, name, facts
        self.constants = constants
        self.wgsl = language is WGSL
        self.parameters = {each.arg: _type(each.annotation) for each in function.args.args}
        self.arrays = {key for key, kind in self.parameters.items() if kind in SIZES}

    def text(self) -> str:
        own, result = self.facts[self.function.name], _type(self.function.returns)
        pairs = zip(self.parameters.items(), own.changed, strict=True)
        parameters = [self._parameter(key, kind, changed) for (key, kind), changed in pairs]
        if own.reads_table and self.language.context[0]:
            parameters.insert(0, self.language.context[0])
        body = list(self._block(self._without_docstring(), 1))
        summary = (ast.get_docstring(self.function) or "").replace("\n", "\n   ").rstrip()
        return "\n".join([f"/* {_ascii(summary)} */", self._head(parameters, result), "{", *body, "}"])

    def _head(self, parameters: list[str], result: str) -> str:
        name, listed = f"{self.name}_{self.function.name}", ", ".join(parameters)
        if self.wgsl:
            return f"fn {name}({listed})" + (f" -> {self.language.types[result]}" if result else "")
        kind = self.language.types[result] if result else "void"
        before = self.language.expanded if self.function.name in EXPANDED else self.language.function
        return f"{before.format(NAME=self.name.upper())}{kind} {name}({listed})"

    def _without_docstring(self) -> list[ast.stmt]:
        return self.function.body[1:] if ast.get_docstring(self.function) else self.function.body

    def _parameter(self, name: str, kind: str, changed: bool) -> str:
        element = self.language.types["Float" if kind in SIZES else kind]
        if self.wgsl:
            return f"{name}: {self._pointer(kind)}" if kind in SIZES else f"{name}: {element}"
        if kind not in SIZES:
            return f"{element} {name}"
        style = self.language.mutable if changed else self.language.readonly
        return style.format(type=element, name=name, size=self._size(kind))

    def _pointer(self, kind: str) -> str:
        return f"ptr<function, array<f32, {self._size(kind)}>>"

    def _size(self, kind: str) -> str:
        size = ast.parse(SIZES[kind], mode="eval").body
        if self.language.width is None:
            return self._expression(size)
        return str(integer(size, {**self.constants, "WIDTH": self.language.width}))

    def _block(self, statements: list[ast.stmt], depth: int) -> Iterator[str]:
        for statement in statements:
            for line in self._statement(statement, depth):
                yield line if line.startswith(" ") else "    " * depth + line

    def _statement(self, statement: ast.stmt, depth: int) -> Iterator[str]:
        match statement:
            case ast.AnnAssign(target=ast.Name(id=name), annotation=annotation, value=value):
                yield from self._declaration(name, _type(annotation), value)
            case ast.Assign(targets=[target], value=value):
                yield f"{self._expression(target)} = {self._expression(value)};"
            case ast.AugAssign(target=target, op=op, value=value):
                yield f"{self._expression(target)} {OPERATORS[type(op)][0]}= {self._expression(value)};"
            case ast.Return(value=value):
                yield f"return {self._expression(value)};" if value else "return;"
            case ast.Expr(value=value):
                yield f"{self._expression(value)};"
            case ast.For(target=ast.Name(id=name), iter=ast.Call(args=args), body=body):
                start, stop = [ast.Constant(0), *args][-2:]
                first, last = self._expression(start), self._expression(stop)
                declared = f"var {name}: i32" if self.wgsl else f"int {name}"
                step = f"{name}++" if self.wgsl else f"++{name}"
                if self.language.lanes and isinstance(stop, ast.Name) and stop.id in LANES:
                    yield self.language.lanes.format(NAME=self.name.upper())
                yield f"for ({declared} = {first}; {name} < {last}; {step}) {{"
                yield from self._block(body, depth + 1)
                yield "}"
            case ast.While(test=test, body=body):
                yield f"while ({self._expression(test)}) {{"
                yield from self._block(body, depth + 1)
                yield "}"
            case ast.If(test=test, body=body, orelse=[]):
                yield f"if ({self._expression(test)}) {{"
                yield from self._block(body, depth + 1)
                yield "}"
            case _:
                raise NotImplementedError(ast.unparse(statement))

    def _declaration(self, name: str, kind: str, value: ast.expr | None) -> Iterator[str]:
        assert value is not None
        element = self.language.types["Float" if kind in SIZES else kind]
        if kind not in SIZES:
            left = f"var {name}: {element}" if self.wgsl else f"{element} {name}"
            yield f"{left} = {self._expression(value)};"
            return
        self.arrays.add(name)
        size = self._size(kind)
        if self.wgsl:
            yield f"var {name}: array<f32, {size}>;"
        elif self.language.zeros and _is_empty(value):
            yield f"{element} {name}[{size}];"
        elif self.language.zeros:
            yield f"{element} {name}[{size}] = {self.language.zeros.format()};"
        else:
            yield f"{element} {name}[{size}];"
            yield f"for (int fill = 0; fill < {size}; ++fill) {name}[fill] = 0.0;"

    def _expression(self, node: ast.expr, outer: int = LOWEST) -> str:
        text, inner = self._operation(node)
        return f"({text})" if inner < outer else text

    def _operation(self, node: ast.expr) -> tuple[str, int]:
        """Return an expression and its precedence."""
        match node:
            case ast.Constant(value=bool() as value):
                return ("true" if value else "false") if self.language.types["Bool"] == "bool" else str(
                    int(value)
                ), CALL
            case ast.Constant(value=float() as value):
                return literal(value) + self.language.suffix, CALL
            case ast.Constant(value=value):
                return str(value), CALL
            case ast.Name(id=name):
                return f"{self.name.upper()}_{name}" if name.isupper() else name, CALL
            case ast.Subscript(value=ast.Name(id=name), slice=index):
                base = f"(*{name})" if self.wgsl and name in self.parameters else name
                return f"{base}[{self._expression(index)}]", CALL
            case ast.BinOp(left=left, op=op, right=right):
                sign, level = OPERATORS[type(op)]
                return f"{self._expression(left, level)} {sign} {self._expression(right, level + 1)}", level
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return f"-{self._expression(operand, UNARY)}", UNARY
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return f"!{self._expression(operand, CALL)}", UNARY
            case ast.Compare(left=left, ops=[op], comparators=[right]):
                sign, level = OPERATORS[type(op)]
                return f"{self._expression(left, level)} {sign} {self._expression(right, level)}", level
            case ast.BoolOp(op=op, values=values):
                sign, level = OPERATORS[type(op)]
                return f" {sign} ".join(self._expression(value, level + 1) for value in values), level
            case ast.IfExp(test=test, body=body, orelse=other):
                if self.wgsl:
                    parts = (self._expression(each) for each in (other, body, test))
                    return f"select({', '.join(parts)})", CALL
                parts = (self._expression(each, CONDITIONAL + 1) for each in (test, body, other))
                return "{} ? {} : {}".format(*parts), CONDITIONAL
            case ast.Call(func=ast.Name(id="copysign"), args=[size, sign]) if "copysign" not in self.language.functions:
                return self._operation(_with_sign(size, sign))
            case ast.Call(func=ast.Name(id=name), args=args):
                return self._call(name, args), CALL
        raise NotImplementedError(ast.unparse(node))

    def _call(self, name: str, args: list[ast.expr]) -> str:
        if name in BUILT_IN:
            spelled = self.language.functions.get(name, name)
            return f"{spelled}({', '.join(map(self._expression, args))})"
        given = [self._argument(each) for each in args]
        reads = name in INTRINSICS or (name in self.facts and self.facts[name].reads_table)
        if reads and self.language.context[1]:
            given.insert(0, self.language.context[1])
        return f"{self.name}_{name}({', '.join(given)})"

    def _argument(self, node: ast.expr) -> str:
        local = isinstance(node, ast.Name) and node.id in self.arrays and node.id not in self.parameters
        return f"&{self._expression(node)}" if self.wgsl and local else self._expression(node)


def _is_empty(value: ast.expr) -> bool:
    match value:
        case ast.Call(func=ast.Name(id="empty")):
            return True
    return False


def _with_sign(size: ast.expr, sign: ast.expr) -> ast.expr:
    """Return the definition of ``copysign``."""
    positive = ast.Compare(sign, [ast.Gt()], [ast.Constant(0.0)])
    return ast.IfExp(positive, size, ast.UnaryOp(ast.USub(), size))


def literal(value: float) -> str:
    """Return a literal with a decimal point in nine digits."""
    text = f"{value:.9g}"
    return text if {".", "e"} & set(text) else f"{text}.0"


def _ascii(text: str) -> str:
    for symbol, word in {"π": "pi", "φ": "phi", "√": "sqrt ", "²": "^2", "λ": "lambda"}.items():
        text = text.replace(symbol, word)
    return text.encode("ascii", "replace").decode()
