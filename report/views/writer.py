"""What the formats that are templates share: a template has one macro for each kind of node."""

from __future__ import annotations

from abc import ABC, abstractmethod
from base64 import b64decode, b64encode
from collections.abc import Mapping
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any, ClassVar

from jinja2 import BytecodeCache, Environment, FileSystemLoader, StrictUndefined, pass_context
from jinja2.bccache import Bucket
from jinja2.runtime import Context
from markupsafe import Markup

from ..document.material import Material
from ..document.narrative import sections
from ..document.parts import Item, slug
from ..document.said import Said
from ..document.tree import Math, Node, Number, Refer, Section, Unit
from ..machine.kept import kept

TEMPLATES = Path(__file__).resolve().parents[2] / "templates"


class Writer(ABC):
    """Prints the nodes of a document in one format.

    `pictures`: what the format needs of each figure that was drawn.
    """

    macros: ClassVar[str]
    """The template with a macro for each kind of node; what needs none is a method here."""

    def __init__(self, material: Material, pictures: Mapping[str, Any]) -> None:
        self.material, self.pictures = material, pictures
        self._used: set[str] = set()

    @cached_property
    def sections(self) -> tuple[Section, ...]:
        """The chapters of the report."""
        return sections(self.material.report.workbook.prose, Said(self.material, self.pictures.keys()))

    @cached_property
    def _macros(self) -> Any:
        return environment().get_template(self.macros).make_module({"w": self})

    def render(self, template: str, **given: Any) -> str:
        """A whole file."""
        return environment().get_template(template).render(given, w=self, report=self.material.report)

    def __call__(self, value: Any) -> Markup:
        """Print a node, a run of inlines, or text."""
        if isinstance(value, tuple):
            return Markup("").join(map(self, value))
        if not isinstance(value, Node):
            return self.escape(value)
        kind = type(value).__name__.lower()
        return (getattr(self, kind, None) or getattr(self._macros, kind))(value)  # type: ignore[no-any-return]

    # --- what a format prints

    @abstractmethod
    def escape(self, text: object) -> Markup:
        """Plain text."""

    @abstractmethod
    def math(self, node: Math) -> Markup:
        """A formula in running text."""

    @abstractmethod
    def number(self, node: Number) -> Markup:
        """A number."""

    @abstractmethod
    def unit(self, node: Unit) -> Markup:
        """A unit; nothing for a pure number."""

    @abstractmethod
    def refer(self, node: Refer) -> Markup:
        """A reference to an equation by its label."""

    # --- what follows from that

    def quantity(self, item: Item) -> Markup:
        """A cell's number, or the code of its error."""
        if item.figure is None:
            return self.escape(item.code if item.printed is None else item.printed)
        return self(Number(item.figure))

    @cached_property
    def exponents(self) -> dict[str, str]:
        """LaTeX of the names that may stand in the exponent of a unit."""
        return {name: self.material.latex(name) for name in self.material.names}

    def first(self, key: str) -> bool:
        """Whether something is mentioned for the first time: only then it gets its identifier."""
        if key in self._used:
            return False
        self._used.add(key)
        return True

    def slug(self, text: str) -> Markup:
        """An identifier made of foreign text."""
        return Markup(slug(text))


@pass_context
def _printed(context: Context, value: Any) -> Markup:
    return context["w"](value)  # type: ignore[no-any-return]


class _Compiled(BytecodeCache):
    """Templates are compiled once, and kept by what they say."""

    def load_bytecode(self, bucket: Bucket) -> None:
        if (found := kept("template", [bucket.key, bucket.checksum], None)) is not None:
            bucket.bytecode_from_string(b64decode(found))

    def dump_bytecode(self, bucket: Bucket) -> None:
        parts = [bucket.key, bucket.checksum]
        kept("template", parts, lambda: b64encode(bucket.bytecode_to_string()).decode())


@lru_cache(maxsize=1)
def environment() -> Environment:
    """The templates' environment: the writer ``w`` prints everything, and a name that is not there raises.

    All templates use the delimiters ``((* *))``, ``((( )))`` and ``((# #))``: LaTeX is full of braces.
    """
    return Environment(
        loader=FileSystemLoader(TEMPLATES),
        bytecode_cache=_Compiled(),
        block_start_string="((*",
        block_end_string="*))",
        variable_start_string="(((",
        variable_end_string=")))",
        comment_start_string="((#",
        comment_end_string="#))",
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=True,
        undefined=StrictUndefined,
        finalize=_printed,
    )
