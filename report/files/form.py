"""JSON of one form: written from a struct, read back into it, told as a JSON schema."""

from __future__ import annotations

import inspect
import json
import re
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any, Final, Literal, TypeVar, get_type_hints

import msgspec

from ..messages.errors import InputError, Location, diagnose

LARGEST = 500_000_000
"""Bytes."""
DIALECT = "https://json-schema.org/draft/2020-12/schema"

SCHEMA: Final = 1
"""Another number says that the file has another form."""
Schema = Literal[1]
Text = Annotated[str, msgspec.Meta(pattern=r"^[^\x00]*$")]
"""JSON can write NUL, and no file and no terminal can hold it."""
Index = tuple[int, ...]


class Form(msgspec.Struct, frozen=True, kw_only=True):
    """What is written in the order of its fields; what may be missing when it is read has a default."""


F = TypeVar("F", bound=Form)


class Malformed(ValueError):
    """A file is not what a build writes."""


def alike(found: object, form: type[F]) -> F:
    """The form of something whose attributes have the names and types of its fields."""
    return msgspec.convert(found, form, from_attributes=True)


def load(path: Path, form: type[F]) -> F:
    """Read a file.

    Raises
    ------
    Malformed
        It cannot be read, or has another form; the sentence says where.
    """
    try:
        if not path.is_file():
            raise Malformed("it is a folder" if path.is_dir() else "there is no such file")
        if path.stat().st_size > LARGEST:
            raise Malformed(f"it has more than {LARGEST:,} bytes")
        content = path.read_bytes()
    except OSError as error:
        raise Malformed(error.strerror or str(error)) from error
    return decoded(content, form)


def decoded(content: bytes, form: type[F]) -> F:
    """The form of a file's content; raises as :func:`load`."""
    try:
        return msgspec.json.decode(content, type=form)
    except msgspec.ValidationError as error:
        raise Malformed(_located(str(error), content, form)) from error
    except (ValueError, RecursionError) as error:
        raise Malformed(f"not JSON: {error}") from error


def read(path: Path, form: type[F], code: str) -> F:
    """Read a file that a user named.

    Raises
    ------
    InputError
        As :func:`load`, with a code of the catalogue.
    """
    try:
        return load(path, form)
    except Malformed as error:
        raise InputError(diagnose(code, Location(path.as_posix()), text=path.name, reason=error)) from error


def _located(said: str, content: bytes, form: type[Form]) -> str:
    """What msgspec said, place first; it names no entries of tables, which are looked up again.

    >>> class Lengths(Form):
    ...     m: dict[str, list[float]]
    >>> _located("Expected `float`, got `str` - at `$.m[...][0]`", b'{"m": {"a": [1], "b": ["2"]}}', Lengths)
    'm.b[0]: expected `float`, got `str`'
    """
    if found := re.search(r"`\$\.(\w+)\[\.\.\.\]", said):
        kind = get_type_hints(form, include_extras=True)[found[1]]
        with suppress(
            msgspec.DecodeError, RecursionError
        ):  # what follows may be no JSON, or the same key again
            table = msgspec.convert(msgspec.json.decode(content)[found[1]], dict[str, Any])
            wrong = (f".{key}" for key in table if not _fits(table, key, kind))
            said = said.replace("[...]", next(wrong, "[...]"), 1)
    said, _, place = said.partition(" - at ")
    if place == "`$.schema`":
        return f'it does not say "schema": {SCHEMA}'
    place = place.replace("`", "").replace("$.", "").replace("$", "the file")
    return f"{place}: {said[:1].lower()}{said[1:]}" if place else f"{said[:1].lower()}{said[1:]}"


def _fits(table: dict[str, Any], key: str, kind: Any) -> bool:
    try:
        msgspec.convert({key: table[key]}, kind)
    except msgspec.ValidationError:
        return False
    return True


def schema(form: type[Form]) -> str:
    """The JSON schema of a form, in JSON."""
    told = {"$schema": DIALECT, **msgspec.json.schema(form)}
    for each in told["$defs"].values():
        each["description"] = inspect.cleandoc(each["description"])
    return indented(told)


def indented(content: Form | dict[str, Any]) -> str:
    """JSON as people read it."""
    return json.dumps(msgspec.to_builtins(content), indent=1, ensure_ascii=False) + "\n"


def text(content: Form) -> str:
    """JSON with a line for each entry of the second level: small, and still good to compare line by line.

    A NaN is no JSON and must not occur: the encoder raises.
    """

    def dump(value: Any) -> str:
        return json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(", ", ": "))

    parts = []
    for key, value in msgspec.to_builtins(content).items():
        if isinstance(value, dict) and value:
            inner = ",\n".join(f"  {dump(k)}: {dump(v)}" for k, v in value.items())
            parts.append(f" {dump(key)}: {{\n{inner}\n }}")
        elif isinstance(value, list) and value:
            inner = ",\n".join(f"  {dump(v)}" for v in value)
            parts.append(f" {dump(key)}: [\n{inner}\n ]")
        else:
            parts.append(f" {dump(key)}: {dump(value)}")
    return "{\n" + ",\n".join(parts) + "\n}\n"
