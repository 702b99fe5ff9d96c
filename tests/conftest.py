"""What all tests share: one hypothesis profile, and `require` for programs outside Python."""

import os
import shutil
from collections.abc import Callable

import pytest
from hypothesis import settings

CI = os.environ.get("CI", "").lower() not in ("", "0", "false")

# No deadline: the first example of a property pays for imports and code generation. Under CI the
# examples are the same in every run, so that a red run can be repeated.
settings.register_profile("loopsheet", deadline=None, print_blob=True, derandomize=CI)
settings.load_profile("loopsheet")


def find_program(*names: str) -> str:
    """Path of the first of these programs that is installed; without any, skip (under CI: fail)."""
    for name in names:
        path = shutil.which(name)
        if path is not None:
            return path
    sentence = f"needs {' or '.join(names)} on the PATH"
    if CI:
        pytest.fail(f"{sentence}: install it in .ci/run", pytrace=False)
    pytest.skip(sentence)


@pytest.fixture(scope="session")
def require() -> Callable[..., str]:
    """Give `require("latexmk")`, or `require("chromium", "chromium-browser")` where names differ."""
    return find_program
