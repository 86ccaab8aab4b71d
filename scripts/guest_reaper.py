"""Removes a guest when its launcher is gone, however it went: stdin ends with the launcher."""

import shutil
import sys

from with_vcan.place import kill_session

if __name__ == "__main__":
    session, folder = sys.argv[1:]
    sys.stdin.read()
    kill_session(int(session))
    shutil.rmtree(folder, ignore_errors=True)
