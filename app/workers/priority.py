"""Process priorities: the server, whose work takes milliseconds, goes before processes that work for seconds.

If `sched_autogroup_enabled` is set, as it usually is, Linux compares niceness only among the processes of one
session. Since version 6.6, a process that wakes up waits for the end of another process's time slice
(milliseconds), unless it requests a shorter slice itself (since 6.12).
"""

import ctypes
import os
import platform
import struct
import sys

_SHORTEST = 100_000  # time slice of a thread [ns]; the shortest that Linux accepts
_DEFAULT = 0  # the slice that Linux chooses
_SCHED_SETATTR = {"x86_64": 314, "aarch64": 274, "riscv64": 274}
_NICENESS = 10  # leaves a tenth of a core to calculations, even under full load of the server


def answer_promptly() -> None:
    """Make this thread, and threads that it starts later, run soon after they wake up."""
    _set_slice(_SHORTEST)


def share_fairly() -> None:
    """Undo `answer_promptly`, which a process inherits from its parent."""
    _set_slice(_DEFAULT)


def give_way() -> None:
    """Lower the priority of this process below others of the session, above all below the server."""
    os.nice(_NICENESS)


def _set_slice(nanoseconds: int) -> bool:
    """Request a time slice; return whether the system accepts the request, which older systems ignore."""
    number = _SCHED_SETATTR.get(platform.machine())
    if sys.platform != "linux" or number is None:
        return False
    policy = os.sched_getscheduler(0)
    if policy != os.SCHED_OTHER:  # the operator has chosen another policy
        return False
    niceness = os.getpriority(os.PRIO_PROCESS, 0)
    attributes = struct.pack("=IIQiIQQQ", 48, policy, 0, niceness, 0, nanoseconds, 0, 0)
    return bool(ctypes.CDLL(None).syscall(number, 0, attributes, 0) == 0)
