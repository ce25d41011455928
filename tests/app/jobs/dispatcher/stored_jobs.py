"""Job handlers that write to the database, and functions to read what they wrote."""

import asyncio

from patience import patient
from patience import until as wait_until
from sqlalchemy import select

from app.storage.tables import BuildRow

KIND = "regenerate"


def describe(error):
    return {"type": type(error).__name__, "detail": str(error)}


def build(key):
    """A unit that leaves a trace of the job in the database."""
    return BuildRow(key=key, model="m", version=1, parameters={}, measurements={}, created="")


def storing(job, context):
    """A handler that stores something and names it."""

    def completion(session):
        session.add(build(job.payload["key"]))
        return f"/builds/{job.payload['key']}"

    return completion


class Failures(list):
    """A hook that remembers how jobs failed and leaves a trace in the same transaction."""

    def __call__(self, session, job, problem):
        self.append((job.id, problem))
        session.add(build(f"failure of {job.payload['key']}"))


def put(jobs, database, key="a", kind=KIND):
    id = database.write(lambda session: jobs.enqueue(session, kind, {"key": key}))
    jobs.wake()
    return id


def ended(jobs, id, seconds=60):
    asyncio.run(jobs.wait(id, patient(seconds)))
    return jobs.get(id)


def builds(database):
    with database.read() as session:
        return sorted(session.scalars(select(BuildRow.key)))


def until(condition):
    wait_until(condition)
