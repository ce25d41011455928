"""A principal's budget of processor time: it counts work, and limits only while others use the server."""

import asyncio
import time

import pytest

from app.identity.door import Rate
from app.identity.limits import LimitReached
from app.identity.principal import Principal
from app.observation.processor_time import METER, Meter, Metered, in_thread

ADA, BEA = (Principal(name, name, "person", frozenset()) for name in ("Ada", "Bea"))
BUDGET = 30.0  # s/min


class Clock:
    def __init__(self):
        self.time = 0.0

    def __call__(self):
        return self.time


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def rate(clock):
    return Rate(clock)


def spend(rate, who, seconds):
    rate.admit(who, BUDGET)
    rate.settle(who, BUDGET, seconds)


def test_alone_a_principal_is_never_refused(rate):
    for _ in range(10_000):
        spend(rate, ADA, 0.1)
    assert rate.counted() == {"Ada": 10_000}


def test_beside_others_an_empty_bucket_refuses_and_states_when_to_return(rate, clock):
    spend(rate, ADA, BUDGET + 2)
    rate.admit(BEA, BUDGET)
    with pytest.raises(LimitReached, match="Ada may use 30 s") as refused:
        rate.admit(ADA, BUDGET)
    assert refused.value.headers == {"Retry-After": "4"}  # 2 s at 0.5 s/s
    rate.admit(BEA, BUDGET)
    clock.time += 4.1
    rate.admit(BEA, BUDGET)
    rate.admit(ADA, BUDGET)


def test_the_limit_ends_when_the_others_have_left(rate, clock):
    spend(rate, ADA, 2 * BUDGET)
    rate.admit(BEA, BUDGET)
    with pytest.raises(LimitReached):
        rate.admit(ADA, BUDGET)
    clock.time += 2
    rate.admit(ADA, BUDGET)


def test_a_debt_is_paid_off_in_ten_seconds(rate):
    for _ in range(100):
        spend(rate, ADA, 10.0)
    rate.admit(BEA, BUDGET)
    with pytest.raises(LimitReached) as refused:
        rate.admit(ADA, BUDGET)
    assert refused.value.headers == {"Retry-After": "10"}


def test_many_cheap_requests_cost_less_than_one_heavy_one(rate):
    for _ in range(1000):
        spend(rate, ADA, 1e-3)
    spend(rate, BEA, BUDGET + 1)
    rate.admit(ADA, BUDGET)
    with pytest.raises(LimitReached):
        rate.admit(BEA, BUDGET)


def work(seconds):
    start = time.thread_time()
    while time.thread_time() - start < seconds:
        pass


def test_a_meter_counts_the_loop_and_its_threads_but_no_other_task():
    async def one(meter, mine, threaded):
        METER.set(meter)

        async def steps():
            work(mine)
            await asyncio.sleep(0)
            await in_thread(work, threaded)

        await Metered(steps(), meter)

    async def both():
        light, heavy = Meter(), Meter()
        await asyncio.gather(one(light, 0.0, 0.0), one(heavy, 0.1, 0.05))
        return light.seconds, heavy.seconds

    light, heavy = asyncio.run(both())
    assert heavy >= 0.15
    assert light < 0.05


def test_metered_work_receives_its_cancellation():
    seen = []

    async def waits():
        try:
            await asyncio.sleep(60)
        except asyncio.CancelledError:
            seen.append("cancelled")
            raise

    async def run():
        async with asyncio.timeout(0.01):
            await Metered(waits(), Meter())

    with pytest.raises(TimeoutError):
        asyncio.run(run())
    assert seen == ["cancelled"]
