"""A number that tells the sources of the native step apart, compiled into it and compared.

Read by ``build.py`` too, before anything is installed: standard library only.
"""

from pathlib import Path
from zlib import crc32


def checksum(room: Path) -> int:
    """CRC-32 of the C, the headers and ``interface.h`` in a checkout's ``tcs_hil/native``."""
    value = 0
    for path in (room / "interface.h", *sorted((room / "src").glob("*.[ch]"))):
        value = crc32(path.read_bytes(), value)
    return value


def is_checkout(room: Path) -> bool:
    """Can they have changed since the build?  Those of an installation cannot."""
    return (room.parent.parent / "setup.py").exists()
