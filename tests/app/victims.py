"""Job functions that misbehave, each in its own way; job processes find them by name."""

import ctypes
import os
import resource
import subprocess
import sys
import time
from pathlib import Path

from app.workers.base import may_share
from templates.core.progress import report


class Awkward(Exception):
    """Pickles, but cannot be unpickled."""

    def __init__(self, first, second):
        super().__init__(f"{first} and {second}")


def process_id():
    return os.getpid()


@may_share(lambda is_shared=True: is_shared)
def shared_process_id(is_shared=True):
    return os.getpid()


@may_share(lambda: True)
def shared_second_fails():
    """Like `second_fails`, but another job may have the process."""
    return second_fails()


def main_module_file():
    return getattr(sys.modules["__main__"], "__file__", None)


def loaded(module):
    return module in sys.modules


def double(number):
    return 2 * number


def count_to(number):
    for step in range(number):
        report(step / number, f"step {step}")
    return number


def large(size):
    return b"x" * size


def bad_value(text):
    raise ValueError(text)


def awkward():
    raise Awkward("this", "that")


def unpicklable():
    return lambda: None


def endless_sum():
    return sum(range(10**15))  # one call into C: no signal handler of Python's would ever run


def sleep(seconds):
    time.sleep(seconds)
    return seconds


def chatter_for_ever():
    while True:
        report(0.5, "still here")


def memory_bomb():
    return len(bytearray(4 * 2**30))


def segfault():
    ctypes.string_at(0)


def abort():
    os.abort()


def leave(code):
    os._exit(code)


def with_grandchild(file):
    child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
    file.write_text(f"{os.getpid()} {child.pid}")
    return child.wait()


def tell_and_sleep(file):
    file.write_text(str(os.getpid()))
    time.sleep(60)


def hoard(megabytes):
    """Keep memory beyond the end of the request."""
    _HOARD.append(bytearray(megabytes * 2**20))
    return os.getpid()


def same(value):
    return value


def standing():
    """Session, process group and slice [ns] of the process."""
    return os.getsid(0), os.getpgid(0), slice_of_thread()


def slice_of_thread():
    """How long the kernel means to let this thread run [ns]; 0 where it does not say."""
    try:
        rows = Path("/proc/thread-self/sched").read_text().splitlines()
    except OSError:
        return 0
    return next((int(row.split()[-1]) for row in rows if row.startswith("se.slice")), 0)


_HOARD = []


def spend(seconds):
    """Use processor time."""
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass
    return os.getpid()


def environment(name):
    return os.environ.get(name)


def processor_limit():
    return os.getpid(), resource.getrlimit(resource.RLIMIT_CPU)[0]


_calls = []


def second_fails():
    """Fails if this process has called it before."""
    _calls.append(1)
    if len(_calls) > 1:
        raise RuntimeError("this process is used")
    return len(_calls)


def wait_for(folder):
    """Leave the id of the process in a folder, and return once somebody puts a file `go` there."""
    (folder / str(os.getpid())).touch()
    while not (folder / "go").exists():
        time.sleep(0.02)


@may_share(lambda *_: True)
def shared_hoard(megabytes):
    """Keep so much memory."""
    hoard(megabytes)
    return os.getpid()


@may_share(lambda *_: True)
def shared_spend(seconds):
    """Use processor time."""
    return spend(seconds)


@may_share(lambda *_: True)
def shared_end():
    """Die at once, as a crash of the kernel does."""
    os._exit(3)
