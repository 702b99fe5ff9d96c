"""A run that is stopped, killed, or finds no room: nothing is left, and what was there is whole or named."""

from __future__ import annotations

import gc
import hashlib
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
import uuid
from collections import Counter
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NoReturn

import msgspec
import pytest
from campaign_sizes import Sizes
from small_report import end_gauge

from loopsheet.report import cli, stages
from loopsheet.report.cli import main
from loopsheet.report.files.form import text
from loopsheet.report.files.manifest import Manifest, read_manifest
from loopsheet.report.machine import staging
from loopsheet.report.machine.background import Background, LateArgument, Telling
from loopsheet.report.machine.scratch import PREFIX, scratch
from loopsheet.report.machine.staging import put, staged
from loopsheet.report.machine.stopping import Stopped, stoppable, unstoppable
from loopsheet.report.messages.errors import OutputError
from loopsheet.report.verification import _outputs

pytestmark = pytest.mark.usefixtures("anew")

Hashes = dict[str, str]


def hashes(folder: Path) -> Hashes:
    """Every file's content, by its relative name; leftovers of ours are not looked into."""
    return {
        p.relative_to(folder).as_posix(): hashlib.sha256(p.read_bytes()).hexdigest()
        for p in sorted(folder.rglob("*"))
        if p.is_file() and PREFIX not in p.relative_to(folder).parts[0]
    }


def left(*folders: Path) -> list[str]:
    return [path.name for folder in folders for path in folder.glob(f"{PREFIX}*")]


def named(out: Path) -> list[str]:
    """What `verify` says of the files that are there, beside the manifest that is there."""
    then = read_manifest(out)
    return [check.message for check in _outputs(out, then, then, "") if not check.passed]


def outputs(made_of: str, **texts: str) -> dict[str, str]:
    """Files, and a manifest that lists them and what they were made of."""
    files = {name.replace("__", "/").replace("_", "."): each for name, each in texts.items()}
    listed = {name: hashlib.sha256(files[name].encode()).hexdigest() for name in sorted(files)}
    digest = hashlib.sha256(made_of.encode()).hexdigest()
    manifest = {"schema": 1, "inputs": {"report.toml": digest}, "outputs": listed, "versions": {}}
    return {**files, "manifest.json": text(msgspec.convert(manifest, Manifest))}


OLD = outputs("old", a_json="old", figures__b_svg="old", gone_txt="old")
NEW = outputs("new", a_json="new", figures__b_svg="new", more_html="new", figures__c_svg="new")


def contents(files: Mapping[str, str]) -> Hashes:
    return {name: hashlib.sha256(text.encode()).hexdigest() for name, text in sorted(files.items())}


def fill(out: Path, files: Mapping[str, str]) -> None:
    for name, each in files.items():
        put(out / name, each)


# --- builds in processes of their own ---


class Build:
    """`loopsheet build` of a small report, that can be stopped."""

    def __init__(self, folder: Path, place: Path, *options: str) -> None:
        self.mark = f"LOOPSHEET_TEST={uuid.uuid4()}"
        self.temporary = place / "tmp"
        self.temporary.mkdir(exist_ok=True)
        name, _, value = self.mark.partition("=")
        # Tests in the background of a shell ignore what comes from the keyboard; a build shall not.
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.process = subprocess.Popen(
            [sys.executable, "-m", "loopsheet", "build", str(folder), "--out", str(place / "out"), *options],
            env={**os.environ, name: value, "TMPDIR": str(self.temporary)},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )
        signal.signal(signal.SIGINT, before)

    def begun(self) -> Build:
        """Wait until it is our code that runs: until then, signals are for Python to tell of."""
        status = Path(f"/proc/{self.process.pid}/status")
        while self.process.poll() is None:
            caught = next((x for x in status.read_text().splitlines() if x.startswith("SigCgt")), "SigCgt: 0")
            if int(caught.split()[1], 16) >> (signal.SIGTERM - 1) & 1:
                break
            time.sleep(0.005)
        return self

    def living(self) -> list[str]:
        """The commands of all processes that it started, however far they went; itself too."""
        found = []
        for process in Path("/proc").glob("[0-9]*"):
            try:
                if self.mark.encode() in (process / "environ").read_bytes():
                    found.append((process / "cmdline").read_bytes().decode())
            except OSError:
                continue  # it has just ended
        return found

    def ended(self, seconds: float = 15) -> bool:
        """Whether all processes end within some time."""
        end = time.monotonic() + seconds
        while self.living() and time.monotonic() < end:
            time.sleep(0.02)
        return not self.living()


@pytest.fixture(scope="module")
def gauge(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Hashes, float]:
    """A folder, its outputs in `out`, and how many seconds a build takes."""
    place = tmp_path_factory.mktemp("gauge")
    end_gauge(place)
    begun = time.monotonic()
    build = Build(place, place, "--to", "json,html")
    told = build.process.communicate()
    assert build.process.returncode == 0, told
    return place, hashes(place / "out"), time.monotonic() - begun


TO_ALL = {signal.SIGINT}
"""A terminal sends it to the whole group."""
needs_proc = pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="needs Linux's /proc")


@needs_proc
@pytest.mark.campaigns
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT], ids=lambda s: s.name)
def test_a_build_stopped_at_any_moment(
    number: signal.Signals,
    gauge: tuple[Path, Hashes, float],
    tmp_path: Path,
    sizes: Sizes,
    summary: Callable[[str], None],
) -> None:
    """No process, no folder, no traceback; the outputs are the old ones or the new, or `verify` says so."""
    folder, new, seconds = gauge
    out, dice, found = tmp_path / "out", random.Random(f"{sizes.seed} {number.name}"), Counter[str]()
    for turn in range(sizes.stopped):
        shutil.rmtree(out, ignore_errors=True)
        if turn % 2:
            fill(out, OLD)
        options = ("--engines",) if turn % 10 == 9 else ()
        build = Build(folder, tmp_path, "--to", "json,html", *options).begun()
        time.sleep(dice.uniform(0, 0.9 * seconds))
        (os.killpg if number in TO_ALL else os.kill)(build.process.pid, number)
        said = build.process.communicate(timeout=60)[1]
        assert build.ended(), build.living()
        assert "Traceback" not in said, said
        if number != signal.SIGKILL:
            assert build.process.returncode in (0, -number, 128 + number), said
            assert left(out, build.temporary) == [], (said, turn)
            assert ("nothing was half-written" in said) is (build.process.returncode == 128 + number)
        now = hashes(out) if out.exists() else {}
        before = contents(OLD) if turn % 2 else {}
        state = "new" if now == new else "old" if now == before else "named"
        if state == "named" and not named(out):
            assert options  # whose manifest tells of more engines
            state = "new"
        found["kept the old" if state == "old" else state] += 1
        found["with leftovers"] += bool(left(out, build.temporary))
    told = ", ".join(f"{count} {name}" for name, count in sorted(found.items()) if count)
    if number != signal.SIGKILL:
        summary(f"{sizes.stopped} builds ended by {number.name} at random moments: {told}")
        return
    shutil.rmtree(tmp_path / "out", ignore_errors=True)
    build = Build(folder, tmp_path, "--to", "json,html")
    build.process.communicate()
    assert left(out, build.temporary) == []
    assert hashes(out) == new
    summary(f"{sizes.stopped} builds ended by {number.name} at random moments: {told}; the next left nothing")


# --- each step of the move ---

STEPS = """
import json, os, signal, sys
from pathlib import Path
from loopsheet.report import cli, stages
from loopsheet.report.machine import staging
from loopsheet.report.machine.stopping import stoppable
fatal, number, out = int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
taken = 0
def counted(real):
    def call(*arguments, **more):
        global taken
        if moving and taken == fatal:
            os.kill(os.getpid(), number)
        taken += moving
        return real(*arguments, **more)
    return call
moving = False
for owner, names in ((os, ("replace", "link", "unlink", "rmdir")), (Path, ("unlink", "mkdir"))):
    for name in names:
        setattr(owner, name, counted(getattr(owner, name)))
with stoppable(), staging.staged(out) as stage:
    for name, text in json.loads(sys.argv[4]).items():
        staging.put(stage / name, text)
    moving = True
print("all", taken)
"""


@pytest.mark.campaigns
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM], ids=lambda s: s.name)
def test_a_move_stopped_at_each_step(
    number: signal.Signals, tmp_path: Path, sizes: Sizes, summary: Callable[[str], None]
) -> None:
    """Killed, it leaves the old files, the new, or what `verify` names; told to end, it ends the move."""
    out, found = tmp_path / "out", Counter[str]()
    for step in range(0, 100, sizes.stride):
        shutil.rmtree(out, ignore_errors=True)
        fill(out, OLD)
        command = [sys.executable, "-c", STEPS, str(step), str(int(number)), str(out), json.dumps(NEW)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode == 0:
            break
        now = hashes(out)
        state = "old" if now == contents(OLD) else "new" if now == contents(NEW) else "named"
        assert bool(named(out)) is (state == "named"), (step, now)
        assert state == "new" or number == signal.SIGKILL, done.stderr
        assert number == signal.SIGKILL or left(out) == []
        found[state] += 1
        with staged(out) as stage:
            assert left(out) == [stage.name]
            put(stage / "a.json", "again")
        assert left(out) == []
    assert step > 12
    assert step - sizes.stride < int(done.stdout.removeprefix("all ")) <= step
    told = ", ".join(f"{count} times {state}" for state, count in sorted(found.items()))
    summary(f"{number.name} at {sum(found.values())} of {step} steps of a move: {told}")


def test_a_reader_finds_each_file_at_each_step(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "out"
    fill(out, OLD)
    real, seen = os.replace, []

    def look(source: Path, target: Path) -> None:
        seen.append({(out / name).exists() for name in OLD if name in NEW})
        real(source, target)

    with staged(out) as stage:
        fill(stage, NEW)
        monkeypatch.setattr(os, "replace", look)
    assert seen == [{True}] * len(NEW)


# --- side by side ---


def test_who_builds_into_the_same_folder_waits_or_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    code = (
        "import sys, time\nfrom pathlib import Path\n"
        "from loopsheet.report.machine.staging import put, staged\n"
        "with staged(Path(sys.argv[1])) as stage:\n"
        "    put(stage / 'a', 'first')\n    print(flush=True)\n    sys.stdin.read()\n"
    )
    other = subprocess.Popen(
        [sys.executable, "-c", code, str(tmp_path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert other.stdout is not None
    assert other.stdin is not None
    other.stdout.readline()
    monkeypatch.setattr(staging, "PATIENCE", 0.1)
    with pytest.raises(OutputError, match="another build writes into"), staged(tmp_path):
        pass
    assert len(left(tmp_path)) == 1
    monkeypatch.setattr(staging, "PATIENCE", 60.0)
    other.stdin.close()
    with staged(tmp_path) as stage:  # waits
        assert (tmp_path / "a").read_text() == "first"
        put(stage / "a", "second")
    assert other.wait() == 0
    other.stdout.close()
    assert (tmp_path / "a").read_text() == "second"


def test_a_folder_that_somebody_works_in_is_not_left_over(tmp_path: Path) -> None:
    (tmp_path / f"{PREFIX}12345678").mkdir()
    (tmp_path / f"{PREFIX}notes").mkdir()
    with scratch(tmp_path) as one, scratch(tmp_path) as other:
        assert sorted(left(tmp_path)) == sorted([one.name, other.name, f"{PREFIX}notes"])
    assert left(tmp_path) == [f"{PREFIX}notes"]


# --- no room ---

WRITE = """
import sys
from pathlib import Path
from loopsheet.report.machine.staging import put, staged
with staged(Path("out/inner")) as stage:
    put(stage / "small.json", "1")
    put(stage / "figures/large.svg", "x" * 100_000)
"""


@pytest.mark.parametrize("reason", ["File too large", "No space left on device"])
def test_no_room_is_a_message(reason: str, tmp_path: Path) -> None:
    if reason == "File too large":
        limit = "ulimit -f 40"
    else:
        limit = f"mount -t tmpfs -o size=40k none '{tmp_path}' && cd . && cd '{tmp_path}' || exit 99"
    command = ["sh", "-c", f'{limit}\n"$0" -c "$1" 2>&1; ls -A', sys.executable, WRITE]
    if reason != "File too large":
        unshare = shutil.which("unshare")
        command = [unshare or "unshare", "--user", "--map-root-user", "--mount", *command]
        if unshare is None or subprocess.run([*command[:4], "true"], check=False).returncode:
            pytest.skip("no small disk can be mounted here")
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (
        f"OutputError: error[LS601]: 'out/inner/figures/large.svg' cannot be written: {reason}" in done.stdout
    )
    assert "help: choose another place (a build's is --out), or make room\n" in done.stdout
    assert "1 error\n" in done.stdout
    assert done.stdout.endswith("1 error\n")  # and nothing is left


def test_too_few_open_files_are_a_message(tmp_path: Path) -> None:
    folder = str(end_gauge(tmp_path))
    done = subprocess.run(
        [sys.executable, "-m", "loopsheet", "build", folder, "--out", str(tmp_path / "out")],
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (8, 8)),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2, done.stderr
    assert "error[LS622]: the machine refuses: Too many open files" in done.stderr
    assert not (tmp_path / "out").exists()


def test_an_output_that_is_full_is_a_message(gauge: tuple[Path, Hashes, float]) -> None:
    out = str(gauge[0] / "out")
    with Path("/dev/full").open("w") as full:
        command = [sys.executable, "-m", "loopsheet", "diff", out, out]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == 2
    assert "error[LS622]: the machine refuses: No space left on device" in done.stderr
    assert "Exception" not in done.stderr


def test_memory_that_is_short_is_no_bug(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise MemoryError

    monkeypatch.setattr(stages, "evaluated", fail)
    assert main(["show", "alpha", "paper"]) == 2
    assert "the machine refuses: no memory is left" in capsys.readouterr().err
    killed = Background(signal.raise_signal, signal.SIGKILL)
    with pytest.raises(OSError, match=r"ended by somebody else \(code -9\)"):
        killed.result()


def test_where_no_process_may_be_begun_the_work_is_done_when_it_is_asked_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    aside = Background(divmod, 7, 2)
    assert aside.result() == (3, 1)
    monkeypatch.setattr(sys, "executable", "/nowhere/python")
    with Background(divmod, 7, 2) as here:
        assert here.result() == (3, 1)
    monkeypatch.undo()
    with Background(divmod, 7, 0) as wrong, pytest.raises(ZeroDivisionError):
        wrong.result()


@pytest.mark.parametrize("program", [sys.executable, "/nowhere/python"])
def test_an_argument_may_be_told_while_a_call_runs(program: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "executable", program)
    many = list(range(100_000))
    with Background(LateArgument.wait, LateArgument()) as aside:
        aside.tell(many)
        assert aside.result() == many
    with Background(LateArgument.wait, LateArgument()):
        pass  # nobody tells it, and nobody waits


def counted(tell: Telling, number: int) -> int:
    """What takes some steps."""
    for each in range(number):
        tell(f"step {each}")
    return number


@pytest.mark.parametrize("program", [sys.executable, "/nowhere/python"])
def test_what_a_call_is_about_is_heard_by_whom_waits(program: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "executable", program)
    heard: list[str] = []
    with Background(counted, Telling(), 3) as aside:
        assert aside.result(heard.append) == 3
    assert heard == ["step 0", "step 1", "step 2"]


# --- how signals are heeded ---


def told(work: Callable[[], None]) -> int:
    """The signal that stopped some work."""
    with pytest.raises(Stopped) as stopped, stoppable():
        work()
    return stopped.value.number


def test_what_must_be_whole_ends_before_we_do() -> None:
    done = []

    def work() -> None:
        with unstoppable():
            os.kill(os.getpid(), signal.SIGTERM)
            done.append(1)
        done.append(2)

    assert told(work) == signal.SIGTERM
    assert done == [1]


def test_a_second_signal_does_not_disturb_what_the_first_takes_back() -> None:
    done = []

    def work() -> None:
        try:
            os.kill(os.getpid(), signal.SIGTERM)
        finally:
            os.kill(os.getpid(), signal.SIGINT)
            done.append(1)

    assert told(work) == signal.SIGTERM
    assert done == [1]


def test_a_signal_in_a_destructor_is_not_lost(capsys: pytest.CaptureFixture[str]) -> None:
    class Last:
        def __del__(self) -> None:
            os.kill(os.getpid(), signal.SIGTERM)

    def work() -> None:
        Last()
        time.sleep(5)

    assert told(work) == signal.SIGTERM
    assert capsys.readouterr().err == ""


def test_what_is_half_made_when_a_signal_comes_does_not_complain(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    complaints: list[Any] = []
    monkeypatch.setattr(sys, "unraisablehook", complaints.append)

    class Half:
        def __init__(self) -> None:
            os.kill(os.getpid(), signal.SIGTERM)
            self.whole = True

        def __del__(self) -> None:
            assert self.whole

    assert told(Half) == signal.SIGTERM
    gc.collect()
    assert not complaints
    assert capsys.readouterr().err == ""


def test_an_import_that_a_signal_ends_is_no_bug(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """What is written in C makes of it what it likes."""

    def compute(*_: object, **__: object) -> None:
        try:
            os.kill(os.getpid(), signal.SIGTERM)
        except KeyboardInterrupt:
            raise ImportError("initialization failed") from None

    monkeypatch.setattr(stages, "evaluated", compute)
    assert main(["check", "paper"]) == 128 + signal.SIGTERM
    assert capsys.readouterr().err.endswith("stopped; nothing was half-written\n")


def test_what_is_ignored_stays_so() -> None:
    """As it is for everything that nohup starts: the tests themselves may be."""
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with stoppable():
            os.kill(os.getpid(), signal.SIGHUP)
        signal.signal(signal.SIGHUP, signal.SIG_DFL)
        with stoppable():
            assert signal.getsignal(signal.SIGHUP) != signal.SIG_DFL
        assert signal.getsignal(signal.SIGHUP) == signal.SIG_DFL
    finally:
        signal.signal(signal.SIGHUP, before)


# --- a process beside a build, told to end at an awkward moment ---

WORKER = """
import os, signal, threading, time
from loopsheet.report.machine import stopping

def told():
    os.kill(os.getpid(), signal.SIGTERM)

class Awkward:
    def __del__(self):
        told()

def work():
    {moment}
    time.sleep(20)
    print("worked")

start = threading.Thread.start
if "{moment}" == "pass":
    threading.Thread.start = lambda self: (start(self), told())
stopping.worker(os.getppid(), work)
"""


@pytest.mark.parametrize("moment", ["pass", "told()", "Awkward()"])
def test_a_worker_that_is_told_to_end_says_nothing(moment: str) -> None:
    """Before somebody catches it, in the work, and in a destructor, where Python only tells of it."""
    done = subprocess.run(
        [sys.executable, "-c", WORKER.format(moment=moment)], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_an_import_that_is_ended_while_the_command_line_is_read_is_no_fault_of_ours(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """What a library makes of a signal that comes in the middle of its import."""

    def parse(_: object) -> NoReturn:
        try:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(5)
        except KeyboardInterrupt:
            raise SystemError("initialisation failed") from None
        raise AssertionError("no signal came")

    monkeypatch.setattr(cli, "_parse", parse)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # in the background it is ignored
    try:
        assert main(["build", "paper"]) == 128 + signal.SIGINT
    finally:
        signal.signal(signal.SIGINT, before)
    assert capsys.readouterr().err == "\nstopped; nothing was half-written\n"


STOPPED_IMPORT = """
import os, signal, sys

class Stopping:
    def find_spec(self, name, *_):
        if name == "loopsheet.report.cli":
            os.kill(os.getpid(), signal.SIGINT)

signal.signal(signal.SIGINT, signal.default_int_handler)  # in the background it is ignored
sys.meta_path.insert(0, Stopping())
from loopsheet.__main__ import command
command()
"""


def test_ctrl_c_while_it_imports_ends_it_without_a_word() -> None:
    run = subprocess.run(
        [sys.executable, "-c", STOPPED_IMPORT], check=False, capture_output=True, text=True, timeout=60
    )
    assert (run.returncode, run.stdout, run.stderr) == (-signal.SIGINT, "", "")
