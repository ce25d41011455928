"""What an operator may set: environment variables that begin with CRANKWRIGHT_, such as CRANKWRIGHT_PORT."""

from pathlib import Path

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
