"""A Dask scheduler and workers for tests, run by the commands that an operator uses."""

import json
import sys
from contextlib import suppress

from patience import patient, until
from serving import alive

from app.settings import Settings
from app.team.processes import LOOPBACK, ChildProgram, free_port, listens
from app.workers.remote.engine import DaskWorker


def commanded(name, folder, *arguments, **environment):
    """A command of the program, as `crankwright …` would run it."""
    return ChildProgram(
        name, [sys.executable, "-m", "app", *arguments], folder / f"{name}.log", environment=environment
    )


class Network:
    """A scheduler and workers, any of which may be killed and started again; a worker has so many places."""

    def __init__(self, folder, workers=2, places=1, scheme="tcp", **environment):
        self.folder, self.port, self.environment = folder, free_port(), environment
        self.places = places
        self.address = f"{scheme}://{LOOPBACK}:{self.port}"
        self.scheduler = self.start_scheduler()
        self.workers = [self.start_worker(f"worker-{number}") for number in range(workers)]

    def start_scheduler(self):
        self.scheduler = commanded(
            "scheduler", self.folder, "scheduler", "--port", str(self.port), **self.environment
        )
        return self.scheduler

    def start_worker(self, name):
        lanes = json.dumps({"geometry": self.places, "analysis": self.places})
        options = ("--scheduler", self.address, "--lanes", lanes)
        return commanded(name, self.folder, "worker", *options, **self.environment)

    def until_listening(self):
        self.scheduler.until(lambda: listens(self.port), patient(30))

    def engine(self, **settings):
        """A server's worker, connected; it sees the places of all workers."""
        engine = DaskWorker.of(Settings(engine=self.address, **settings))
        until(lambda: engine.capacity("geometry"), lambda count: count == self.places * len(self.workers))
        return engine

    def stop(self):
        for process in (*self.workers, self.scheduler):
            process.stop()


def process_in(file):
    """The process id that a job has written to a file."""

    def read():
        with suppress(OSError, ValueError):
            return int(file.read_text())

    return until(read)


def until_gone(pid):
    until(lambda: not alive(pid))
