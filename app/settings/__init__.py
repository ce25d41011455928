"""Settings of the operator: environment variables that begin with CRANKWRIGHT_, such as CRANKWRIGHT_PORT."""

from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, SecretStr
from pydantic_settings import BaseSettings, SettingsConfigDict

from app.settings.hosts import check_entry, check_network
from app.settings.machines import Count, Lane, check_certificate, check_collector, check_engine, check_lanes

Certificate = Annotated[Path | None, AfterValidator(check_certificate), Field(validate_default=True)]


class Settings(BaseSettings):
    """Settings of one server process; a folder list is written as JSON: `["/srv/own-templates"]`."""

    model_config = SettingsConfigDict(env_prefix="CRANKWRIGHT_", frozen=True, extra="forbid")

    data: Path = Field(Path("crankwright-data"), description="folder of the database and the artifacts")
    database_url: str | None = Field(None, description="SQLAlchemy URL; a SQLite file in `data` if not given")
    database_pool: int = Field(
        16, gt=0, description="connections to PostgreSQL for writing; the same number again for reading"
    )
    artifacts_url: str | None = Field(
        None,
        description=(
            "where files are stored: `s3://bucket`, `s3://bucket/prefix`, or `file:///folder` for a folder "
            "that all servers share; a folder in `data` if not given"
        ),
    )
    s3_endpoint: str | None = Field(
        None, description="address of an S3 server other than Amazon's; keys come from the AWS environment"
    )
    artifact_cache_mb: int = Field(2048, gt=0, description="local copies of a bucket's files [MiB]")
    stamp_keys: Path | None = Field(
        None,
        description="folder of the keys that sign stamps, which the servers of a team share; `stamp-keys` in "
        "`data` if not given; a team's files stay unsigned without it",
    )
    engine: Annotated[str, AfterValidator(check_engine)] = Field(
        "local",
        description="what runs jobs: `local`, or a Dask scheduler such as `tls://scheduler:8786`",
    )
    dask_ca: Certificate = Field(
        None, description="certificate of the authority that signs Dask's certificates"
    )
    dask_cert: Certificate = Field(None, description="certificate of this machine for Dask's connections")
    dask_key: Certificate = Field(None, description="key of that certificate")
    lanes: Annotated[dict[Lane, Count], AfterValidator(check_lanes)] = Field(
        {"geometry": 1, "analysis": 1},
        description="number of jobs of each kind that `crankwright worker` runs at the same time",
    )
    lease_seconds: float = Field(
        30.0,
        gt=0,
        description="if the server of a job sends no sign of life for this time, the job is queued again [s]",
    )
    beat_seconds: float = Field(10.0, gt=0, description="time between two signs of life [s]")
    poll_seconds: float = Field(
        5.0, gt=0, description="time between two checks of the database by a server of a team [s]"
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
            "accepted host names besides localhost, 127.0.0.0/8, [::1] and the address on which the service "
            'listens on; `"*.example.com"` stands for all sub-domains'
        ),
    )
    trusted_proxies: tuple[Annotated[str, AfterValidator(check_network)], ...] = Field(
        ("127.0.0.1", "::1"),
        description=(
            "addresses and networks of the proxies whose `X-Forwarded-For` and `X-Forwarded-Proto` count: "
            '`["10.0.0.0/24"]`'
        ),
    )
    body_limit: int = Field(
        16 * 2**20, gt=0, description="largest request body that is not the file of a model [bytes]"
    )
    upload_limit: int = Field(200 * 2**20, gt=0, description="largest uploaded file of a model [bytes]")
    template_folders: tuple[Path, ...] = Field((), description="folders of a team's own templates")
    template_seconds: float = Field(
        30.0, gt=0, description="longest time for loading and checking a team's file [s]"
    )
    freecad: Path | None = Field(
        None, description="folder of FreeCAD's modules; the usual folder of Linux distributions if not given"
    )
    freecad_python: str = Field(
        "/usr/bin/python3",
        description="the Python for which FreeCAD was built; it builds models from .FCStd files",
    )
    creoson_url: str | None = Field(
        None,
        description="address of CREOSON on the machine with a running Creo: `http://127.0.0.1:9056/creoson`",
    )
    creoson_folder: Path | None = Field(
        None, description="folder into which Creo exports, as a path on this machine"
    )
    creoson_exports: str | None = Field(
        None,
        description="the same folder as a path on Creo's machine; equal to `creoson_folder` if not given",
    )
    creo_version: int | None = Field(
        None, ge=7, le=99, description="major version of Creo; required by CREOSON from Creo 7 on"
    )
    wait_seconds: float = Field(2.0, ge=0, description="how long a request waits for its job by default [s]")
    queue_limit: int = Field(
        1000, gt=0, description="largest number of queued jobs; further jobs are refused"
    )
    client_queue_limit: int = Field(50, gt=0, description="largest number of queued jobs of one client")
    workers: int = Field(1, gt=0, description="jobs that run at the same time, in addition to one analysis")
    job_deadline: float = Field(60.0, gt=0, description="longest run of one job process [s]")
    job_memory_mb: int = Field(
        3072, gt=0, description="memory of one job process in addition to the program [MiB]"
    )
    calculation_processes: int = Field(
        0, ge=0, description="processes for expensive calculations; 0: one for each core"
    )
    calculation_waiting: int = Field(
        200, gt=0, description="expensive calculations that may wait before new ones are refused"
    )
    calculation_deadline: float = Field(
        30.0,
        gt=0,
        description="how long an answer waits for its calculation, which then continues as a job [s]",
    )
    calculation_job_deadline: float = Field(300.0, gt=0, description="longest run of one calculation [s]")
    calculation_memory_mb: int = Field(
        2048, gt=0, description="memory of one calculation in addition to the program [MiB]"
    )
    analysis_deadline: float = Field(300.0, gt=0, description="longest run of one analysis of a solid [s]")
    analysis_memory_mb: int = Field(6144, gt=0, description="memory limit of an analysis of a solid [MiB]")
    cache_mb: int = Field(256, gt=0, description="memory for cached results [MiB]")
    keep_jobs_days: float = Field(
        90, gt=0, description="how long an ended job is listed [days of operation]; at least `keep_keys_days`"
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
        description="how long servers that share files keep a file to which no row refers [h]",
    )
    drain_seconds: float = Field(10.0, gt=0, description="longest time from SIGTERM to the end [s]")
    connections: int = Field(1000, gt=0, description="connections at the same time; others get 503")
    connections_per_address: int = Field(
        200,
        gt=0,
        description=(
            "connections of one address at the same time, or requests that a trusted proxy forwards for it; "
            "others get 503"
        ),
    )
    header_seconds: float = Field(
        10.0, gt=0, description="longest time for receiving the header of a request [s]"
    )
    body_seconds: float = Field(10.0, gt=0, description="longest pause while a request body arrives [s]")
    write_seconds: float = Field(
        60.0, gt=0, description="longest time for which a client may stop reading its answer [s]"
    )
    slowest_rate: float = Field(
        16384,
        gt=0,
        description="lowest average rate at which a client must send a body or read an answer [bytes/s]",
    )
    keep_alive_seconds: int = Field(
        5, gt=0, description="longest idle time of a connection between requests [s]"
    )
    oidc_issuer: str | None = Field(None, description="OpenID provider with which users sign in")
    oidc_client: str | None = Field(None, description="client id of this service at that provider")
    oidc_secret: SecretStr | None = Field(None, description="client secret of this service at that provider")
    session_hours: float = Field(12, gt=0, description="how long a browser stays signed in [h]")
    principal_processor_seconds: float = Field(
        30,
        gt=0,
        description="processor time per minute that requests of one principal may use at one server while "
        "others use it; further requests get 429 [s/min]",
    )
    principal_storage_mb: int = Field(
        20480, gt=0, description="files that one principal may have stored [MiB]"
    )
    principal_seconds: float = Field(
        36000, gt=0, description="calculation time that one principal may use per day (UTC) [s]"
    )
    traces_url: Annotated[str | None, AfterValidator(check_collector)] = Field(
        None, description="address of the OpenTelemetry collector for traces: `http://127.0.0.1:4318`"
    )
    streams: int = Field(200, gt=0, description="largest number of open event streams")
    streams_per_client: int = Field(
        20, gt=0, description="largest number of open event streams of one client"
    )
    log_level: Literal["debug", "info", "warning", "error"] = Field(
        "warning", description="least severe level that is logged; `info` logs a line for each request"
    )
    log_format: Literal["text", "json"] = Field(
        "text", description="format of a log line: plain text, or a JSON object"
    )

    @property
    def stop_seconds(self) -> float:
        """Return the part of the drain time reserved for jobs and the database after the last request [s]."""
        return min(4.0, 0.4 * self.drain_seconds)
