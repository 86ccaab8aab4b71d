"""The guest's root: the host's files, read-only, under a layer that is thrown away."""

from __future__ import annotations

from pathlib import Path

from .kernelcalls import load_module, make_root, mount

SHARED = Path("/run/with-vcan")  # where the guest sees the folder it shares with the host

_STAGE = Path("/mnt")  # any folder of the host that nobody needs before the switch
_DEPENDENCIES_FIRST = ("overlay", "can-dev", "can", "can-raw", "can-bcm", "can-gw", "vcan", "vxcan")
_STANDARD_STREAMS = {"fd": "", "stdin": "/0", "stdout": "/1", "stderr": "/2"}


def load_modules(folder: str) -> None:
    """Load the CAN and overlay modules found anywhere in the folder; raises OSError."""
    found = {path.stem: path for path in Path(folder).rglob("*.ko")}
    for name in _DEPENDENCIES_FIRST:
        if name in found:
            load_module(found[name])


def switch(shared: Path, writable: list[str]) -> None:
    """Change to a root where the command may write anything and the host keeps its files.

    Args:
        shared: the folder shared with the host, as seen from the host.
        writable: folders of the host whose changes are to reach it.
    """
    mount("stage", str(_STAGE), "tmpfs", "mode=755")
    upper, work, root = (_STAGE / name for name in ("upper", "work", "root"))
    for folder in (upper, work, root):
        folder.mkdir()
    mount("root", str(root), "overlay", f"lowerdir=/,upperdir={upper},workdir={work}")
    _mount_kernel_views(root)
    for host_folder in writable:
        mount("hostfs", f"{root}{host_folder}", "hostfs", host_folder)
    (root / SHARED.relative_to("/")).mkdir()
    mount("hostfs", f"{root}{SHARED}", "hostfs", str(shared))
    make_root(root)
    for name, number in _STANDARD_STREAMS.items():
        Path("/dev", name).symlink_to(f"/proc/self/fd{number}")


def _mount_kernel_views(root: Path) -> None:
    mount("proc", f"{root}/proc", "proc")
    mount("sysfs", f"{root}/sys", "sysfs")
    mount("run", f"{root}/run", "tmpfs", "mode=755")
    mount("devtmpfs", f"{root}/dev", "devtmpfs", "mode=755")
    for name in ("pts", "shm"):
        (root / "dev" / name).mkdir()
    mount("devpts", f"{root}/dev/pts", "devpts", "ptmxmode=0666")
    mount("shm", f"{root}/dev/shm", "tmpfs", "mode=1777")  # noqa: S108 - the guest's own
