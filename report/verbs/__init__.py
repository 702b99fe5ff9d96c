"""The verbs of the command line, one module each: HELP, what it takes, and what it does.

A verb is listed here and imports what it needs when it runs, so that ``--help`` answers at once.
"""

from . import (
    budget,
    build,
    card,
    check,
    crate,
    design,
    diff,
    new,
    prove,
    schema,
    show,
    validate,
    verify,
    watch,
    why,
)

VERBS = {
    "build": build,
    "watch": watch,
    "check": check,
    "prove": prove,
    "show": show,
    "why": why,
    "budget": budget,
    "design": design,
    "card": card,
    "new": new,
    "verify": verify,
    "validate": validate,
    "diff": diff,
    "crate": crate,
    "schema": schema,
}
"""In the order of ``--help``."""
