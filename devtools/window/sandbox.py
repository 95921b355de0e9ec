"""Sandbox with a real Blender: Debian by debootstrap, entered by chroot in namespaces of its own.

Whatever is mounted for the sandbox is mounted in a namespace that ends with the command that needed
it, killed or not, so nothing is ever left mounted. Linux and root only. Standard library only.
"""

from __future__ import annotations

import json
import os
import platform
import shlex
import shutil
import subprocess
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..environment.libraries import install
from ..environment.problem import SetUpError
from ..environment.progress import run_quietly
from ..environment.virtual_environment import CACHE

SUITE = "trixie"  # of Debian: Blender 4.3
PACKAGES = (
    *("blender", "imagemagick", "libgl1-mesa-dri", "python3-numpy", "xdotool", "xvfb"),
    *("python3-cattr", "python3-requests"),  # Blender 5.2 registers no extensions without these
)
# Ends with whoever started it, and then ends all that it started itself.
ALONE = shlex.split(
    "setpriv --pdeathsig KILL unshare --mount --pid --fork --kill-child --mount-proc"
)
# dpkg waits for the disk after each file otherwise, and the pages are for people who read here.
FAST = "force-unsafe-io\npath-exclude=/usr/share/doc/*\npath-exclude=/usr/share/man/*\n"
FETCHING = ("Acquire::Check-", "Acquire::http", "Acquire::Retries")
VARIABLES = {
    "DEBIAN_FRONTEND": "noninteractive",
    "HOME": "/root",
    "LANG": "C.UTF-8",
    "PATH": "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin",
}


@dataclass(frozen=True)
class Mount:
    """A folder of this machine and its mount point in the sandbox."""

    folder: Path
    place: str
    writable: bool = False


@dataclass(frozen=True)
class Sandbox:
    """A folder with a Debian in it."""

    folder: Path

    @property
    def stamp(self) -> Path:
        return self.folder.with_suffix(".json")

    @property
    def log(self) -> Path:
        return self.folder.with_suffix(".log")

    @property
    def ready(self) -> bool:
        try:
            return self.folder.is_dir() and json.loads(self.stamp.read_text()) == list(PACKAGES)
        except (OSError, ValueError):
            return False

    def run(
        self,
        script: str,
        *,
        mounts: Sequence[Mount],
        variables: Mapping[str, str],
        limit: float,
        log: Path,
    ) -> int:
        """Run a shell script in the sandbox, without network, with a /tmp and a home that it loses.

        Its output goes to `log`. Whatever it started ends with it, after `limit` seconds at the
        latest. The exit code, or 124 where it ran out of time.
        """
        command = [*ALONE, "--net", "sh", "-ec", self.entry_script(script, mounts, variables)]
        with log.open("wb") as output:
            try:  # past the limit it is killed, and so, by --kill-child, all that it started
                return subprocess.run(
                    command,
                    stdin=subprocess.DEVNULL,
                    stdout=output,
                    stderr=subprocess.STDOUT,
                    start_new_session=True,
                    timeout=limit,
                ).returncode
            except subprocess.TimeoutExpired:
                return 124

    def entry_script(
        self, script: str, mounts: Sequence[Mount], variables: Mapping[str, str]
    ) -> str:
        """Shell script that mounts the sandbox's surroundings and enters by chroot."""
        inside = shlex.quote(str(self.folder))
        lines = [
            f"mount -t proc proc {inside}/proc",
            *(f"mount --rbind /{name} {inside}/{name}" for name in ("dev", "sys")),
            *(f"mount -t tmpfs tmpfs {inside}/{name}" for name in ("tmp", "mnt", "root")),
            f"chmod 1777 {inside}/tmp",
        ]
        for mount in mounts:
            there = f"{inside}{shlex.quote(mount.place)}"
            lines += [f"mkdir -p {there}", f"mount --bind {shlex.quote(str(mount.folder))} {there}"]
            if not mount.writable:
                lines.append(f"mount -o remount,bind,ro {there}")
        return "\n".join([*lines, f"exec {shlex.join(self.entry(script, variables))}"])

    def entry(self, script: str, variables: Mapping[str, str]) -> list[str]:
        """Command that runs a shell script in the sandbox, with no other variables than these."""
        settings = [f"{name}={value}" for name, value in {**VARIABLES, **variables}.items()]
        return ["chroot", str(self.folder), "env", "-i", *settings, "sh", "-ec", script]


def prepare(suite: str = SUITE) -> Sandbox:
    """The sandbox, made where it is missing. Raises SetUpError with what this machine lacks."""
    sandbox = Sandbox(CACHE / "window" / suite)
    check_rights()
    if sandbox.ready:
        return sandbox
    begun = time.monotonic()
    sandbox.folder.parent.mkdir(parents=True, exist_ok=True)
    sandbox.log.unlink(missing_ok=True)
    if shutil.which("debootstrap") is None:
        install("The window's sandbox is made by debootstrap", ("debootstrap",), sandbox.log)
    make(sandbox, suite)
    print(f"The sandbox with Blender was made in {time.monotonic() - begun:.0f} s", flush=True)
    return sandbox


def check_rights() -> None:
    """Raises SetUpError where a sandbox can be neither made nor entered."""
    if not Path("/etc/debian_version").is_file():
        raise SetUpError("The window's sandbox is made of Debian's packages; run this on Debian.")
    if os.geteuid() != 0:
        raise SetUpError("Only root may make and enter the window's sandbox; run this with sudo.")
    probe = subprocess.run([*ALONE, "--net", "true"], capture_output=True, text=True)
    if probe.returncode != 0:
        problem = probe.stderr.strip() or f"unshare ended with code {probe.returncode}"
        raise SetUpError(f"The window's sandbox needs the right to mount, not had here: {problem}")


def make(sandbox: Sandbox, suite: str) -> None:
    """A new sandbox in place of whatever lies there."""
    sandbox.stamp.unlink(missing_ok=True)
    remove(sandbox.folder)
    source = mirror()
    bootstrap = ["debootstrap", "--variant=minbase", suite, str(sandbox.folder)]
    bootstrap += [source] if source else []
    run_quietly(f"Fetching Debian {suite}", [*ALONE, *bootstrap], sandbox.log)
    (sandbox.folder / "etc/dpkg/dpkg.cfg.d/fast").write_text(FAST)
    (sandbox.folder / "etc/apt/apt.conf.d/99machine").write_text(fetch_settings())
    line = "apt-get install -y --no-install-recommends " + " ".join(PACKAGES)
    script = f"mount -t proc proc /proc; apt-get update; {line}; apt-get clean"
    command = [*ALONE, *sandbox.entry(script, {})]
    run_quietly("Installing Blender in it (400 MB to fetch)", command, sandbox.log)
    sandbox.stamp.write_text(json.dumps(PACKAGES))


def mirror() -> str | None:
    """The place that this machine's own release of Debian comes from; None where apt has none."""
    own = platform.freedesktop_os_release().get("VERSION_CODENAME", "")
    command = ["apt-get", "indextargets", "--no-release-info", "Identifier: Packages"]
    command += ["--format", "$(RELEASE) $(COMPONENT) $(REPO_URI)"]
    told = subprocess.run(command, capture_output=True, text=True).stdout.splitlines()
    start = f"{own} main "
    return next((line.removeprefix(start) for line in told if line.startswith(start)), None)


def fetch_settings() -> str:
    """This machine's apt settings for fetching, such as a proxy, for the sandbox's apt."""
    told = subprocess.run(["apt-config", "dump", "Acquire"], capture_output=True, text=True)
    lines = told.stdout.splitlines()
    return "".join(f"{line}\n" for line in lines if line.startswith(FETCHING))


def remove(folder: Path) -> None:
    """Remove a sandbox. Raises SetUpError where something is mounted in it."""
    for line in Path("/proc/mounts").read_text().splitlines():
        place = Path(line.split()[1].replace("\\040", " "))
        if place == folder or folder in place.parents:
            raise SetUpError(f"{place} is mounted; unmount it, and run this again.")
    if folder.exists():
        shutil.rmtree(folder)
