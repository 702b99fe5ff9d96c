"""What the tests beside it share: npm packages, environments of Python, edited workbooks."""

import fcntl
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from spreadsheets import Cells, Recalculate


@pytest.fixture(scope="session")
def npm_packages(require: Callable[..., str]) -> Callable[[Path], Path]:
    """Install the pinned packages of a folder of tests, once and outside of the checkout."""

    def install(folder: Path) -> Path:
        npm, lock = require("npm"), (folder / "package-lock.json").read_text(encoding="utf-8")
        cache = Path.home() / ".cache" / "loopsheet" / folder.name
        cache.mkdir(parents=True, exist_ok=True)
        with (cache / "lock").open("w") as waiting:  # for tests in another process
            fcntl.flock(waiting, fcntl.LOCK_EX)
            _install(npm, folder, cache, lock)
        return cache / "node_modules"

    return install


def _install(npm: str, folder: Path, cache: Path, lock: str) -> None:
    installed = cache / "package-lock.json"
    if not installed.exists() or installed.read_text(encoding="utf-8") != lock:
        shutil.copy(folder / "package.json", cache)
        (cache / "npm-shrinkwrap.json").write_text(lock, encoding="utf-8")
        command = [npm, "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--no-update-notifier"]
        run = subprocess.run(command, cwd=cache, capture_output=True, text=True, timeout=300, check=False)
        assert run.returncode == 0, run.stderr
        installed.write_text(lock, encoding="utf-8")


@pytest.fixture(scope="session")
def environment() -> Callable[..., Path]:
    """Install a lock of requirements/ for an interpreter, once and outside of the checkout."""

    def install(lock: str, python: str = sys.executable) -> Path:
        """The interpreter of the environment, beside which its commands are."""

        def run(*command: str | Path) -> str:
            done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
            assert done.returncode == 0, done.stderr
            return done.stdout

        path = Path(__file__).parents[2] / "requirements" / f"{lock}.txt"
        asked = path.read_text(encoding="utf-8") + run(python, "-c", "import sys; print(sys.version)")
        number = run(python, "-c", "import sys; print('%d.%d' % sys.version_info[:2])").strip()
        home = Path.home() / ".cache" / "loopsheet" / f"{lock}-{number}"
        own, installed = home / "bin" / "python", home / "installed.txt"
        if not installed.exists() or installed.read_text(encoding="utf-8") != asked:
            run(python, "-m", "venv", "--clear", home)
            pip = (own, "-m", "pip", "--quiet", "--disable-pip-version-check")
            run(*pip, "install", "--require-hashes", "-r", path)
            installed.write_text(asked, encoding="utf-8")
        return own

    return install


@pytest.fixture(scope="session")
def recalculate(require: Callable[..., str], tmp_path_factory: pytest.TempPathFactory) -> "Recalculate":
    """Give `recalculate(books)`: the cells of workbooks after LibreOffice computed them, each by its name."""
    import spreadsheets  # most tests need none

    def read(books: Mapping[str, bytes]) -> "Cells":
        soffice = require("soffice", "libreoffice")
        return spreadsheets.recalculate(soffice, tmp_path_factory.mktemp("office"), books)

    return read
