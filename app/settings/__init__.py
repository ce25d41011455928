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
    database_url: str | None = Field(None, description="SQLAlchemy URL; default: a SQLite file in `data`")
    database_pool: int = Field(
        16, gt=0, description="simultaneous write connections to PostgreSQL; the same number for reading"
    )
    artifacts_url: str | None = Field(
        None,
        description=(
            "file store: `s3://bucket`, `s3://bucket/prefix`, or `file:///folder` for a folder that "
            "all servers share; default: a folder in `data`"
        ),
    )
    s3_endpoint: str | None = Field(
        None, description="address of an S3 server other than Amazon's; keys come from the AWS environment"
    )
    artifact_cache_mb: int = Field(
        2048, gt=0, description="disk space for local copies of a bucket's files [MiB]"
    )
    engine: Annotated[str, AfterValidator(check_engine)] = Field(
        "local",
        description="where jobs run: `local`, or a Dask scheduler such as `tls://scheduler:8786`",
    )
    dask_ca: Certificate = Field(None, description="certificate of the authority for Dask's certificates")
    dask_cert: Certificate = Field(None, description="this process's certificate in the Dask network")
    dask_key: Certificate = Field(None, description="key of that certificate")
    lanes: Annotated[dict[Lane, Count], AfterValidator(check_lanes)] = Field(
        {"geometry": 1, "analysis": 1},
        description="simultaneous jobs of `crankwright worker`, by kind of work",
    )
    lease_seconds: float = Field(
        30.0, gt=0, description="time without a heartbeat of its server after which a job is queued again [s]"
    )
    beat_seconds: float = Field(10.0, gt=0, description="time between two heartbeats [s]")
    poll_seconds: float = Field(
        5.0, gt=0, description="time after which a server of a team checks the database without a hint [s]"
    )
    minimum_free_mb: int = Field(
        200, ge=0, description="free disk space below which /readyz returns 503 [MiB]"
    )
    owner: str = Field(
        "", max_length=80, description="legal owner in the title blocks of drawings (ISO 7200)"
    )
    host: str = "127.0.0.1"
    port: int = Field(8000, ge=0, le=65535)
    allowed_hosts: tuple[Annotated[str, AfterValidator(check_entry)], ...] = Field(
        (),
        description=(
            "host names of the service besides localhost, 127.0.0.0/8, [::1] and the address it "
            'listens on; `"*.example.com"` means all sub-domains'
        ),
    )
    body_limit: int = Field(16 * 2**20, gt=0, description="largest request body [bytes]")
    template_folders: tuple[Path, ...] = Field((), description="folders of a team's own templates")
    template_seconds: float = Field(
        30.0, gt=0, description="longest time to load and check a team's file [s]"
    )
    freecad: Path | None = Field(
        None, description="folder of FreeCAD's modules; default: where Linux distributions install it"
    )
    freecad_python: str = Field(
        "/usr/bin/python3",
        description="the Python that FreeCAD was built for; it draws models in .FCStd files",
    )
    creoson_url: str | None = Field(
        None, description="address of CREOSON on the machine with Creo: `http://127.0.0.1:9056/creoson`"
    )
    creoson_folder: Path | None = Field(
        None, description="folder into which Creo exports, by its path on this machine"
    )
    creoson_exports: str | None = Field(
        None, description="path of the same folder on Creo's machine; default: `creoson_folder`"
    )
    creo_version: int | None = Field(
        None, ge=7, le=99, description="major version of Creo, which CREOSON needs from Creo 7 on"
    )
    wait_seconds: float = Field(2.0, ge=0, description="how long a request waits for its job by default [s]")
    queue_limit: int = Field(
        1000, gt=0, description="largest number of queued jobs; further ones are refused"
    )
    client_queue_limit: int = Field(50, gt=0, description="largest number of queued jobs of one client")
    workers: int = Field(1, gt=0, description="simultaneous jobs, in addition to one analysis")
    job_deadline: float = Field(60.0, gt=0, description="longest run time of a job process [s]")
    job_memory_mb: int = Field(
        3072, gt=0, description="memory limit of a job process, without the program itself [MiB]"
    )
    calculation_processes: int = Field(
        0, ge=0, description="processes for expensive calculations; 0: one for each core"
    )
    calculation_waiting: int = Field(
        32, gt=0, description="largest number of waiting expensive calculations; further ones are refused"
    )
    calculation_deadline: float = Field(
        30.0,
        gt=0,
        description="how long a request waits for its calculation, which then continues as a job [s]",
    )
    calculation_job_deadline: float = Field(300.0, gt=0, description="longest run time of a calculation [s]")
    calculation_memory_mb: int = Field(
        2048, gt=0, description="memory limit of a calculation, without the program itself [MiB]"
    )
    analysis_deadline: float = Field(
        300.0, gt=0, description="longest run time of an analysis of a solid [s]"
    )
    analysis_memory_mb: int = Field(6144, gt=0, description="memory limit of an analysis of a solid [MiB]")
    cache_mb: int = Field(256, gt=0, description="memory for cached results [MiB]")
    keep_jobs_days: float = Field(
        90, gt=0, description="how long an ended job is listed, at least `keep_keys_days` [days of run time]"
    )
    keep_keys_days: float = Field(
        7, gt=0, description="how long an Idempotency-Key is remembered [days of run time]"
    )
    keep_events_days: float = Field(
        7, gt=0, description="how long an event can be read again by its number [days of run time]"
    )
    keep_builds_days: float = Field(
        90, ge=1, description="how long a build that no revision uses is kept [days of run time]"
    )
    keep_files_hours: float = Field(
        24,
        ge=2,
        description="how long servers that share a database keep a file that no row names [h]",
    )
    drain_seconds: float = Field(
        10.0, gt=0, description="longest time from SIGTERM to the end of the server [s]"
    )
    connections: int = Field(
        1000, gt=0, description="largest number of simultaneous connections; further ones get 503"
    )
    header_seconds: float = Field(10.0, gt=0, description="longest time to receive the head of a request [s]")
    body_seconds: float = Field(10.0, gt=0, description="longest pause while a body arrives [s]")
    write_seconds: float = Field(
        60.0, gt=0, description="longest time in which a client may read too slowly [s]"
    )
    slowest_rate: float = Field(
        16384, gt=0, description="lowest average rate at which a client must send or read [bytes/s]"
    )
    keep_alive_seconds: int = Field(
        5, gt=0, description="longest idle time of a connection between requests [s]"
    )
    oidc_issuer: str | None = Field(None, description="address of the OpenID provider for signing in")
    oidc_client: str | None = Field(None, description="this service's client id at that provider")
    oidc_secret: SecretStr | None = Field(None, description="this service's client secret at that provider")
    session_hours: float = Field(12, gt=0, description="how long a browser stays signed in [h]")
    principal_rate: float = Field(
        600, gt=0, description="largest request rate of one principal; further requests get 429 [1/min]"
    )
    principal_storage_mb: int = Field(
        20480, gt=0, description="largest size of the files that one principal may store [MiB]"
    )
    principal_seconds: float = Field(
        36000, gt=0, description="calculation time of one principal per day (UTC) [s]"
    )
    traces_url: Annotated[str | None, AfterValidator(check_collector)] = Field(
        None, description="OpenTelemetry collector that receives traces: `http://127.0.0.1:4318`"
    )
    streams: int = Field(200, gt=0, description="largest number of open event streams")
    streams_per_client: int = Field(
        20, gt=0, description="largest number of open event streams of one client"
    )
    log_level: Literal["debug", "info", "warning", "error"] = Field(
        "warning", description="lowest level that is logged; `info` logs a line for each request"
    )
    log_format: Literal["text", "json"] = Field(
        "text", description="format of log lines: text for people, or JSON objects"
    )

    @property
    def stop_seconds(self) -> float:
        """Return the part of the drain time reserved for jobs and the database after the last request [s]."""
        return min(4.0, 0.4 * self.drain_seconds)
