"""Requests to a service whose template `sleeper` takes a requested time."""

from itertools import count

from serving import API
from test_workers import eventually

from app.catalogue.discovery import find_templates

SLEEPER = f"{API}/templates/sleeper/versions/1"


FILM = find_templates(()).get("oil_film", 2)


FILM_PLACE = f"{API}/templates/oil_film/versions/2"


def begun(log, count=1):
    """The processes in which the sleeper has begun, once they are so many."""
    assert eventually(lambda: len(log.read_text().split()) >= count, 20)
    return [int(pid) for pid in log.read_text().split()]


nights = count(1)


def sleep(http, duration="1 ms", mood="good", **headers):
    """Ask for a sleep; a few nanoseconds more each time, since an equal question finds its earlier answer."""
    number, unit = duration.split()
    nanoseconds = next(nights) * {"s": 1e-9, "ms": 1e-6}[unit]
    return sleep_exactly(http, f"{float(number) + nanoseconds!r} {unit}", mood, **headers)


def sleep_exactly(http, duration, mood="good", **headers):
    """Ask for a sleep."""
    body = {"inputs": {"duration": duration, "mood": mood}}
    return http.post(f"{SLEEPER}/evaluate", json=body, headers=headers)


def ended(http, place):
    """A job once it has ended."""
    end = lambda: http.get(place).json()["state"] not in ("queued", "running")  # noqa: E731
    assert eventually(end, 30)
    return http.get(place).json()


def followed(http, answer):
    """The answer, or that of the job: other work of the machine comes before processes of niceness 10."""
    if answer.status_code != 202:
        return answer
    job = ended(http, answer.headers["Location"])
    assert job["state"] == "done", job["problem"]
    return http.get(job["result"])


def without_time(answer):
    """An answer without what differs from run to run."""
    return {name: part for name, part in answer.items() if name != "seconds"}
