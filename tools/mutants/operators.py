"""All small mistakes that a program can make in a file of Python, C or JavaScript, as changes of its text.

In Python they come from the syntax tree: comparisons, arithmetic, signs, numbers, truth values, branches, arguments,
returns, names that go in pairs. In C and JavaScript they come from the tokens: comparisons, arithmetic, logic, numbers.
Annotations, decorators, docstrings, texts and formats are left alone, and so is code at the level of a module except
its numbers.
"""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

COMPARED = {
    "<": ["<=", ">"], "<=": ["<", ">="], ">": [">=", "<"], ">=": [">", "<="], "==": ["!="], "!=": ["=="],
    "in": ["not in"], "not in": ["in"], "is": ["is not"], "is not": ["is"], "===": ["!=="], "!==": ["==="],
}  # fmt: skip
ADDED = {
    "+": ["-"], "-": ["+"], "*": ["/", "+"], "/": ["*"], "**": ["*"], "//": ["/"], "%": ["//"], "&": ["|"], "|": ["&"],
    "<<": [">>"], ">>": ["<<"],
}  # fmt: skip
LOGIC = {"and": ["or"], "or": ["and"], "&&": ["||"], "||": ["&&"]}
PAIRS = (
    ("min", "max"), ("minimum", "maximum"), ("any", "all"), ("argmin", "argmax"), ("nanmin", "nanmax"), ("sin", "cos"),
    ("sinh", "cosh"), ("floor", "ceil"), ("ones", "zeros"), ("log", "log1p"), ("exp", "expm1"), ("sum", "prod"),
    ("isnan", "isfinite"), ("startswith", "endswith"), ("append", "extend"), ("fmin", "fmax"),
)  # fmt: skip
PAIR = dict(PAIRS) | {second: first for first, second in PAIRS}


@dataclass(frozen=True)
class Change:
    """One mistake: the bytes from `start` to `stop` of a file become `new`. `kind`: the operator that made it."""

    file: str
    start: int
    stop: int
    new: str
    kind: str

    def applied(self, text: str) -> str:
        source = text.encode()
        return (source[: self.start] + self.new.encode() + source[self.stop :]).decode()

    def line(self, text: str) -> int:
        """Number of the line of the change."""
        return 1 + text.encode()[: self.start].count(b"\n")

    def shown(self, text: str) -> str:
        """The change on one line of text, with the text around it."""
        source = text.encode()
        begin = source.rfind(b"\n", 0, self.start) + 1
        end = source.find(b"\n", self.stop)
        around = [source[begin : self.start], source[self.start : self.stop], source[self.stop : end]]
        before, old, after = (re.sub(r"\s+", " ", part.decode()) for part in around)
        return f"{before.lstrip()}[{old} -> {self.new}]{after}"


def changes(file: str, text: str) -> list[Change]:
    """All mistakes that can be made in a file of this name and text, in their order; some may not compile."""
    make = _in_python if Path(file).suffix == ".py" else _in_tokens
    mistakes = {change for change in make(file, text) if change.applied(text) != text}
    return sorted(mistakes, key=lambda change: (change.start, change.stop, change.new))


# Python ------------------------------------------------------------------------------------------------------------


def _in_python(file: str, text: str) -> Iterator[Change]:
    source = text.encode()
    begins = [0]
    for line in source.split(b"\n"):
        begins.append(begins[-1] + len(line) + 1)

    def place(node: ast.AST) -> tuple[int, int]:
        return begins[node.lineno - 1] + node.col_offset, begins[node.end_lineno - 1] + node.end_col_offset

    def between(left: ast.AST, right: ast.AST, table: dict, kind: str) -> Iterator[Change]:
        """The operator between two operands, which parentheses, comments and white space may surround."""
        start, stop = place(left)[1], place(right)[0]
        pattern = rb"not\s+in\b|is\s+not\b|\b(?:in|is|and|or)\b|[<>=!]=|\*\*|//|<<|>>|[<>+\-*/%&|]"
        gap = re.sub(rb"#[^\n]*", lambda match: b" " * len(match[0]), source[start:stop])
        if match := re.search(pattern, gap):
            for new in table.get(re.sub(r"\s+", " ", match[0].decode()), ()):
                yield Change(file, start + match.start(), start + match.end(), new, kind)

    for node, inside in _walked(ast.parse(text)):
        match node:
            case ast.Constant(value=value) if isinstance(value, bool) and inside:
                yield Change(file, *place(node), str(not value), "truth")
            case ast.Constant(value=value) if isinstance(value, (int, float)) and not isinstance(value, bool):
                for new in _numbers(value):
                    yield Change(file, *place(node), new, "number")
            case ast.Compare(left=left, comparators=rights) if inside:
                for first, second in zip([left, *rights], rights, strict=False):
                    yield from between(first, second, COMPARED, "comparison")
            case ast.BinOp(left=left, right=right) if inside and not isinstance(left, ast.JoinedStr):
                yield from between(left, right, ADDED, "arithmetic")
            case ast.BoolOp(values=values) if inside:
                for first, second in zip(values, values[1:], strict=False):
                    yield from between(first, second, LOGIC, "logic")
            case ast.UnaryOp(op=op) if inside and not isinstance(op, ast.UAdd):
                start = place(node)[0]
                yield Change(file, start, start + (3 if isinstance(op, ast.Not) else 1), "", "sign")
            case ast.If(test=test) | ast.IfExp(test=test) if inside:
                yield Change(file, place(test)[0], place(test)[1], "True", "branch")
                yield Change(file, place(test)[0], place(test)[1], "False", "branch")
            case ast.Break() | ast.Continue():
                yield Change(file, *place(node), "continue" if isinstance(node, ast.Break) else "break", "branch")
            case ast.AugAssign(target=target, value=value):
                yield from between(target, value, ADDED, "arithmetic")
            case ast.Return(value=ast.Tuple(elts=[first, second, *_])):
                yield _swapped(file, source, place(first), place(second), "return")
            case ast.Return(value=value) if value is not None and not isinstance(value, ast.Constant):
                yield Change(file, *place(value), "None", "return")
            case ast.Expr(value=ast.Call()) if inside:
                yield Change(file, *place(node), "pass", "statement")
            case ast.Attribute(attr=name) | ast.Name(id=name) if inside and name in PAIR:
                stop = place(node)[1]
                yield Change(file, stop - len(name), stop, PAIR[name], "name")
        if isinstance(node, ast.Call) and inside:
            for first, second in zip(node.args, node.args[1:], strict=False):
                if not isinstance(first, ast.Starred) and not isinstance(second, ast.Starred):
                    yield _swapped(file, source, place(first), place(second), "argument")
            for keyword in node.keywords:
                if keyword.arg is not None:
                    yield _without(file, source, place(keyword))


def _walked(tree: ast.AST) -> Iterator[tuple[ast.AST, bool]]:
    """The nodes that may hold a mistake, and whether each is inside a function."""
    waiting = [(tree, False)]
    while waiting:
        node, inside = waiting.pop()
        yield node, inside
        for name, value in ast.iter_fields(node):
            if name in ("annotation", "returns", "decorator_list", "type_params", "format_spec", "type_comment"):
                continue
            if name == "bases" or (isinstance(node, ast.Raise) and name == "exc" and _is_message(value)):
                continue
            within = inside or isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda))
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST):
                    waiting.append((child, within))


def _is_message(raised) -> bool:
    """Whether the raised object is an error with a single text."""
    return isinstance(raised, ast.Call) and all(isinstance(part, ast.Constant | ast.JoinedStr) for part in raised.args)


def _numbers(value: float) -> list[str]:
    if isinstance(value, int):
        return [str(value + 1)] + ([str(value - 1)] if value > 0 else [])
    return [repr(2.0 * value), repr(0.5 * value)] if value else ["1.0"]


def _swapped(file: str, source: bytes, first: tuple[int, int], second: tuple[int, int], kind: str) -> Change:
    middle = source[first[1] : second[0]]
    new = source[second[0] : second[1]] + middle + source[first[0] : first[1]]
    return Change(file, first[0], second[1], new.decode(), kind)


def _without(file: str, source: bytes, place: tuple[int, int]) -> Change:
    """A call without one of its keywords, and without the comma before or after it."""
    start, stop = place
    if comma := re.search(rb",\s*$", source[:start]):
        return Change(file, comma.start(), stop, "", "argument")
    behind = re.match(rb"\s*,?\s*", source[stop:])
    return Change(file, start, stop + behind.end(), "", "argument")


# C and JavaScript --------------------------------------------------------------------------------------------------

TOKEN = re.compile(
    r"(?P<skip>//[^\n]*|/\*.*?\*/|^[ \t]*\#[^\n]*(?:\\\n[^\n]*)*"
    r"|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'|`(?:\\.|[^`\\])*`"
    r"|(?<=[=(,:])\s*/(?![/*])(?:\\.|\[[^\]]*\]|[^/\\\n])+/[a-z]*)"
    r"|(?P<number>0x[0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_$][\w$]*)"
    r"|(?P<operator>===|!==|=>|->|\+\+|--|[-+*/&|^%<>=!]=|&&|\|\||<<|>>|\?\?|\?\.|[-+*/%<>=!&|^~?:;,.(){}\[\]])",
    re.DOTALL | re.MULTILINE,
)
TYPES = {
    *("double", "int", "void", "char", "const", "float", "long", "size_t", "static", "restrict", "unsigned", "return"),
}


def _in_tokens(file: str, text: str) -> Iterator[Change]:
    tokens = [match for match in TOKEN.finditer(text) if match.lastgroup != "skip"]

    def change(token: re.Match, new: str, kind: str) -> Change:
        start, stop = (len(text[:at].encode()) for at in token.span())
        return Change(file, start, stop, new, kind)

    for before, token, after in zip(tokens, tokens[1:], tokens[2:], strict=False):
        word = token[0]
        binary = (before.lastgroup in ("number", "name") and before[0] not in TYPES) or before[0] in (")", "]")
        if token.lastgroup == "number" and "x" not in word:
            value = float(word)
            whole = value.is_integer() and not re.search(r"[.eE]", word)
            for new in _numbers(int(value) if whole else value):
                yield change(token, new, "number")
        elif word in LOGIC:
            yield change(token, LOGIC[word][0], "logic")
        elif word in COMPARED and word not in ("in", "is") and binary:
            for new in COMPARED[word]:
                yield change(token, new, "comparison")
        elif word in ADDED and binary and after[0] not in ("*", ")"):
            for new in (new for new in ADDED[word] if new != "//"):
                yield change(token, new, "arithmetic")
        elif word == "-" and not binary:
            yield change(token, "", "sign")
        elif word in ("+=", "-="):
            yield change(token, {"+=": "-=", "-=": "+="}[word], "arithmetic")
        elif token.lastgroup == "name" and word in PAIR and before[0] == "." or word in ("fmin", "fmax"):
            yield change(token, PAIR[word], "name")
        elif word in ("true", "false"):
            yield change(token, "false" if word == "true" else "true", "truth")
        elif word == "?" and file.endswith((".js", ".c", ".h")) and binary:
            yield change(token, "&& false ?", "branch")
