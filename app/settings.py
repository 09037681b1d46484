"""What an operator may choose about the service."""

from __future__ import annotations

import os
import secrets
from dataclasses import dataclass, field
from pathlib import Path


def default_data() -> Path:
    """The data folder: SERVOIDENT_DATA, or a folder of this user; on Windows beside the cache of compiled kernels."""
    if os.environ.get("SERVOIDENT_DATA"):
        return Path(os.environ["SERVOIDENT_DATA"])
    if not hasattr(os, "getuid") and os.environ.get("LOCALAPPDATA"):
        return Path(os.environ["LOCALAPPDATA"]) / "servoident" / "data"
    return Path(os.environ.get("XDG_DATA_HOME") or Path.home() / ".local" / "share") / "servoident"


@dataclass(frozen=True)
class Settings:
    """Where data live, where the service listens, and what it refuses.

    `token` is the start token, the admin's; without one given a new one is drawn at every start. `database_url` is a
    SQLite file in the data folder unless a PostgreSQL URL is given. `blobs` is a folder or s3://BUCKET/PREFIX, by
    default a folder in the data folder.
    """

    data: Path = field(default_factory=default_data)
    host: str = "127.0.0.1"
    port: int = 8000
    token: str = field(
        default_factory=lambda: os.environ.get("SERVOIDENT_TOKEN") or secrets.token_urlsafe(32), repr=False
    )
    database_url: str = field(default="", repr=False)
    blobs: str = ""
    cache_size: int = 20 << 30  # bytes of copies on this machine, where the blobs are in S3
    allowed_hosts: tuple[str, ...] = ()  # beside the loopback names, host or host:port
    proxies: tuple[str, ...] = ()  # addresses or networks whose X-Forwarded-For and -Proto are believed
    rate: float = 100.0  # requests a second of one token, ten times as many at once; 0 is no limit
    failures: int = 10  # wrong tokens a minute from one address
    largest_upload: int = 1 << 30  # bytes
    reserve: int = 256 << 20  # bytes of the disk: with less free, uploads are refused
    log: str = "text"  # or "json"
    webhook_hosts: tuple[str, ...] = ()  # the only ones that webhooks may reach: see app/webhooks/hosts.py
    webhook_key: str = field(default_factory=lambda: os.environ.get("SERVOIDENT_WEBHOOK_KEY", ""), repr=False)
    keep_raw: int | None = None  # days for which raw runs that no set in force needs are kept; for ever where None
    laboratory: str = ""  # of reports, where neither the data set nor the request names one
    logo: Path | None = None  # PNG or JPEG at the head of reports
    executor: str = "servoident-1"  # of the job queue; one process an executor

    @property
    def database(self) -> str:
        """URL of the application's database."""
        return self.database_url or f"sqlite:///{self.data / 'servoident.sqlite'}"

    @property
    def queue_database(self) -> str:
        """URL of the job queue's own database."""
        return self.database_url or f"sqlite:///{self.data / 'queue.sqlite'}"

    def make_folders(self) -> None:
        """Create the data folder, readable by this user only."""
        self.data.mkdir(mode=0o700, parents=True, exist_ok=True)
        self.data.chmod(0o700)
