"""What an operator may set: environment variables that begin with CRANKWRIGHT_, such as CRANKWRIGHT_PORT."""

from pathlib import Path
from typing import Literal

from pydantic import Field
from pydantic_settings import BaseSettings, SettingsConfigDict


class Settings(BaseSettings):
    """Settings of one server process; a folder list is written as JSON: `["/srv/own-templates"]`."""

    model_config = SettingsConfigDict(env_prefix="CRANKWRIGHT_", frozen=True, extra="forbid")

    data: Path = Field(Path("crankwright-data"), description="folder of the database and the artifacts")
    database_url: str | None = Field(None, description="SQLAlchemy URL; a SQLite file in `data` if not given")
    host: str = "127.0.0.1"
    port: int = Field(8000, ge=0, le=65535)
    body_limit: int = Field(16 * 2**20, gt=0, description="largest request body [bytes]")
    template_folders: tuple[Path, ...] = Field((), description="folders of a team's own templates")
    wait_seconds: float = Field(2.0, ge=0, description="how long an answer waits for its job [s]")
    queue_limit: int = Field(200, gt=0, description="jobs that may be queued before new ones are refused")
    workers: int = Field(1, gt=0, description="jobs that run at the same time, beside one analysis")
    job_deadline: float = Field(60.0, gt=0, description="longest run of one job process [s]")
    job_memory_mb: int = Field(3072, gt=0, description="memory of one job process beside the program [MiB]")
    analysis_deadline: float = Field(300.0, gt=0, description="longest run of one analysis of a solid [s]")
    analysis_memory_mb: int = Field(6144, gt=0, description="memory of one such analysis [MiB]")
    drain_seconds: float = Field(10.0, gt=0, description="longest time from SIGTERM to the end [s]")
    connections: int = Field(1000, gt=0, description="connections at the same time; others get 503")
    header_seconds: float = Field(10.0, gt=0, description="longest time for the head of a request [s]")
    header_limit: int = Field(65536, gt=0, description="largest head of a request [bytes]")
    address_limit: int = Field(32768, gt=0, description="longest path with its query [bytes]")
    body_seconds: float = Field(10.0, gt=0, description="longest pause while a body comes [s]")
    write_seconds: float = Field(60.0, gt=0, description="longest time in which an answer is not read [s]")
    slowest_rate: float = Field(
        16384, gt=0, description="what a body brings, or a client reads, on average at least [bytes/s]"
    )
    keep_alive_seconds: int = Field(5, gt=0, description="longest rest of a connection between requests [s]")
    streams: int = Field(200, gt=0, description="streams of events that may be open")
    streams_per_client: int = Field(20, gt=0, description="of one client")
    log_level: Literal["debug", "info", "warning", "error"] = Field(
        "warning", description="what is logged; `info` has a line for each request"
    )
    log_format: Literal["text", "json"] = "text"

    @property
    def stop_seconds(self) -> float:
        """The part of the drain time that is kept for jobs and database, after the last request [s]."""
        return min(4.0, 0.4 * self.drain_seconds)
