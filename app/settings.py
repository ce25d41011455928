"""What an operator may set: environment variables that begin with CRANKWRIGHT_, such as CRANKWRIGHT_PORT."""

from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, Field
from pydantic_settings import BaseSettings, SettingsConfigDict

from app.hosts import check_entry


class Settings(BaseSettings):
    """Settings of one server process; a folder list is written as JSON: `["/srv/own-templates"]`."""

    model_config = SettingsConfigDict(env_prefix="CRANKWRIGHT_", frozen=True, extra="forbid")

    data: Path = Field(Path("crankwright-data"), description="folder of the database and the artifacts")
    database_url: str | None = Field(None, description="SQLAlchemy URL; a SQLite file in `data` if not given")
    minimum_free_mb: int = Field(200, ge=0, description="free disk space below which /readyz says 503 [MiB]")
    host: str = "127.0.0.1"
    port: int = Field(8000, ge=0, le=65535)
    allowed_hosts: tuple[Annotated[str, AfterValidator(check_entry)], ...] = Field(
        (),
        description=(
            "host names that the service answers to beside localhost, 127.0.0.0/8, [::1] and the address it "
            'listens on; `"*.example.com"` stands for all sub-domains'
        ),
    )
    body_limit: int = Field(16 * 2**20, gt=0, description="largest request body [bytes]")
    template_folders: tuple[Path, ...] = Field((), description="folders of a team's own templates")
    template_seconds: float = Field(
        30.0, gt=0, description="longest time in which a team's file is loaded and checked [s]"
    )
    wait_seconds: float = Field(2.0, ge=0, description="how long an answer waits for its job [s]")
    queue_limit: int = Field(1000, gt=0, description="jobs that may be queued before new ones are refused")
    client_queue_limit: int = Field(50, gt=0, description="jobs of one client that may be queued")
    workers: int = Field(1, gt=0, description="jobs that run at the same time, beside one analysis")
    job_deadline: float = Field(60.0, gt=0, description="longest run of one job process [s]")
    job_memory_mb: int = Field(3072, gt=0, description="memory of one job process beside the program [MiB]")
    calculation_processes: int = Field(
        0, ge=0, description="processes for expensive calculations; 0: as many as cores"
    )
    calculation_waiting: int = Field(
        32, gt=0, description="expensive calculations that may wait before new ones are refused"
    )
    calculation_deadline: float = Field(
        30.0,
        gt=0,
        description="how long an answer waits for its calculation, which then goes on as a job [s]",
    )
    calculation_job_deadline: float = Field(300.0, gt=0, description="longest run of one calculation [s]")
    calculation_memory_mb: int = Field(
        2048, gt=0, description="memory of one calculation beside the program [MiB]"
    )
    analysis_deadline: float = Field(300.0, gt=0, description="longest run of one analysis of a solid [s]")
    analysis_memory_mb: int = Field(6144, gt=0, description="memory of one such analysis [MiB]")
    cache_mb: int = Field(256, gt=0, description="memory for results that are kept to be used again [MiB]")
    keep_jobs_days: float = Field(
        90, gt=0, description="how long an ended job is listed [days of operation]; at least as long as keys"
    )
    keep_keys_days: float = Field(
        7, gt=0, description="how long an Idempotency-Key is remembered [days of operation]"
    )
    keep_builds_days: float = Field(
        90, ge=1, description="how long a build that no revision uses is kept [days of operation]"
    )
    drain_seconds: float = Field(10.0, gt=0, description="longest time from SIGTERM to the end [s]")
    connections: int = Field(1000, gt=0, description="connections at the same time; others get 503")
    header_seconds: float = Field(10.0, gt=0, description="longest time for the head of a request [s]")
    body_seconds: float = Field(10.0, gt=0, description="longest pause while a body comes [s]")
    write_seconds: float = Field(60.0, gt=0, description="longest time in which an answer is not read [s]")
    slowest_rate: float = Field(
        16384, gt=0, description="what a body brings, or a client reads, on average at least [bytes/s]"
    )
    keep_alive_seconds: int = Field(5, gt=0, description="longest rest of a connection between requests [s]")
    streams: int = Field(200, gt=0, description="streams of events that may be open")
    streams_per_client: int = Field(20, gt=0, description="streams of events that one client may have open")
    log_level: Literal["debug", "info", "warning", "error"] = Field(
        "warning", description="what is logged; `info` has a line for each request"
    )
    log_format: Literal["text", "json"] = Field(
        "text", description="how a line of the log is written: for people, or a JSON object"
    )

    @property
    def stop_seconds(self) -> float:
        """The part of the drain time that is kept for jobs and database, after the last request [s]."""
        return min(4.0, 0.4 * self.drain_seconds)
