"""Run another program that ends with its parent process: `python -m app.team.tether …`.

A pipe (`app.workers.lifeline`) ties the program and its process group to the process that started it. They
end with that process, even after `kill -9`.
"""

from __future__ import annotations

import os
import pwd
import sys

from app.workers.lifeline import hang_on


def main(reader: int, user: str, command: list[str]) -> None:
    """Tie this process group to the pipe, switch to the user if one is named, and run the command."""
    hang_on(reader, os.getpgid(0))
    for descriptor in _others(reader):
        os.set_inheritable(descriptor, True)  # the signal belongs to the open file
    if user:
        entry = pwd.getpwnam(user)
        os.initgroups(user, entry.pw_gid)
        os.setgid(entry.pw_gid)
        os.setuid(entry.pw_uid)
    os.execvp(command[0], command)


def _others(reader: int) -> list[int]:
    """Return the descriptors of the pipe that `hang_on` has opened in addition to the reader."""
    pipe = os.stat(f"/proc/self/fd/{reader}").st_ino
    descriptors = []
    for name in os.listdir("/proc/self/fd"):
        descriptor = int(name)
        try:
            if descriptor != reader and os.fstat(descriptor).st_ino == pipe:
                descriptors.append(descriptor)
        except OSError:  # the one that listed them
            continue
    return descriptors


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2], sys.argv[3:])
