"""Run by the environment of roc-validator, not by ours: what it says of a crate, without any network.

The only thing that it would fetch is the JSON-LD context that every RO-Crate names. It gets the one that the
package rocrate ships; a request for anything else fails.
"""

import importlib.resources
import json
import sys
from typing import Any

from rocrate_validator import models, services  # type: ignore[import-not-found]
from rocrate_validator.utils import http  # type: ignore[import-not-found]

CONTEXT = importlib.resources.files("rocrate").joinpath("data", "ro-crate.jsonld").read_text(encoding="utf-8")


class Answer:
    status_code = 200
    ok = True
    text = CONTEXT

    @property
    def headers(self) -> dict[str, str]:
        return {"Content-Type": "application/ld+json"}

    def json(self) -> Any:
        return json.loads(CONTEXT)


def get(requester: object, url: str, **_: object) -> Answer:
    if url != "https://w3id.org/ro/crate/1.1/context":
        raise RuntimeError(f"{url} was asked for")
    return Answer()


http.HttpRequester.get = get
settings = services.ValidationSettings(
    rocrate_uri=sys.argv[1],
    profile_identifier="ro-crate-1.1",
    requirement_severity=models.Severity.RECOMMENDED,
    no_cache=True,
)
result = services.validate(settings)
issues = [[issue.severity.name, issue.message] for issue in result.get_issues()]
json.dump({"checks": len(result.executed_checks), "issues": issues}, sys.stdout)
