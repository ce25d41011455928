"""Settings of the operator: environment variables that begin with CRANKWRIGHT_, such as CRANKWRIGHT_PORT."""

from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, SecretStr
from pydantic_settings import BaseSettings, SettingsConfigDict

from app.settings.hosts import check_entry
from app.settings.machines import Count, Lane, check_certificate, check_collector, check_engine, check_lanes

Certificate = Annotated[Path | None, AfterValidator(check_certificate), Field(validate_default=True)]


class Settings(BaseSettings):
    """Settings of one server process; a folder list is written as JSON: `["/srv/own-templates"]`."""

    model_config = SettingsConfigDict(env_prefix="CRANKWRIGHT_", frozen=True, extra="forbid")

    data: Path = Field(Path("crankwright-data"), description="folder of the database and the artifacts")
    database_url: str | None = Field(None, description="SQLAlchemy URL; a SQLite file in `data` if not given")
    database_pool: int = Field(
        16, gt=0, description="connections to PostgreSQL that write at the same time; as many read"
    )
    artifacts_url: str | None = Field(
        None,
        description=(
            "where files are: `s3://bucket`, `s3://bucket/prefix`, or `file:///folder` for a folder that "
            "all servers share; a folder in `data` if not given"
        ),
    )
    s3_endpoint: str | None = Field(
        None, description="address of an S3 server other than Amazon's; keys come from the AWS environment"
    )
    artifact_cache_mb: int = Field(2048, gt=0, description="local copies of a bucket's files [MiB]")
    engine: Annotated[str, AfterValidator(check_engine)] = Field(
        "local",
        description="what runs jobs: `local`, or a Dask scheduler such as `tls://scheduler:8786`",
    )
    dask_ca: Certificate = Field(None, description="certificate of the authority that signs those of Dask")
    dask_cert: Certificate = Field(None, description="own certificate in the network of Dask")
    dask_key: Certificate = Field(None, description="key of that certificate")
    lanes: Annotated[dict[Lane, Count], AfterValidator(check_lanes)] = Field(
        {"geometry": 1, "analysis": 1},
        description="jobs that `crankwright worker` runs at the same time, by kind of work",
    )
    lease_seconds: float = Field(
        30.0, gt=0, description="after so long without a sign of its server a job is queued again [s]"
    )
    beat_seconds: float = Field(10.0, gt=0, description="time between two such signs [s]")
    poll_seconds: float = Field(
        5.0, gt=0, description="how often a server of a team looks into the database without a hint [s]"
    )
    minimum_free_mb: int = Field(200, ge=0, description="free disk space below which /readyz says 503 [MiB]")
    owner: str = Field(
        "", max_length=80, description="legal owner of drawings, in their title blocks (ISO 7200)"
    )
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
    freecad: Path | None = Field(
        None, description="folder of FreeCAD's modules; where Linux distributions have it if not given"
    )
    freecad_python: str = Field(
        "/usr/bin/python3",
        description="the Python that FreeCAD was built for: it draws models in .FCStd files",
    )
    creoson_url: str | None = Field(
        None, description="CREOSON beside a running Creo: `http://127.0.0.1:9056/creoson`"
    )
    creoson_folder: Path | None = Field(
        None, description="folder into which Creo exports, as this service names it"
    )
    creoson_exports: str | None = Field(
        None, description="the same folder as Creo names it; as `creoson_folder` if not given"
    )
    creo_version: int | None = Field(
        None, ge=7, le=99, description="main version of Creo, from Creo 7 on: CREOSON has to know it"
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
    keep_events_days: float = Field(
        7, gt=0, description="how long an event can be read again by its number [days of operation]"
    )
    keep_builds_days: float = Field(
        90, ge=1, description="how long a build that no revision uses is kept [days of operation]"
    )
    keep_files_hours: float = Field(
        24,
        ge=2,
        description="how long several servers keep a file that no row names [h]",
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
    oidc_issuer: str | None = Field(None, description="OpenID provider by which people sign in")
    oidc_client: str | None = Field(None, description="this service's name at that provider")
    oidc_secret: SecretStr | None = Field(None, description="and its secret there")
    session_hours: float = Field(12, gt=0, description="how long a browser stays signed in [h]")
    principal_rate: float = Field(600, gt=0, description="requests of one principal; others get 429 [1/min]")
    principal_storage_mb: int = Field(
        20480, gt=0, description="files that one principal may have stored [MiB]"
    )
    principal_seconds: float = Field(
        36000, gt=0, description="calculation that one principal may use on a day (UTC) [s]"
    )
    traces_url: Annotated[str | None, AfterValidator(check_collector)] = Field(
        None, description="OpenTelemetry collector that traces are sent to: `http://127.0.0.1:4318`"
    )
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
        """Return the share of the drain time kept for jobs and database after the last request [s]."""
        return min(4.0, 0.4 * self.drain_seconds)
