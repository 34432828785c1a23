"""What the INI file says about serving: section [WEB], and the files of a display. Read once, at the start.

A server that can be reached from another computer moves a machine that somebody may stand at, so it wants a token and
TLS, or it does not start.
"""

from __future__ import annotations

import ipaddress
import os
import ssl
from dataclasses import dataclass
from pathlib import Path

from nml import namespace
from nml.errors import ConfigError
from nml.inifile import IniFile

DEFAULT_PORT = 8080
LOOPBACK = "127.0.0.1"
PORT_VARIABLE = "PYEMC_WEB_PORT"  # the wizard hands its port on to the machine that it starts
UPLOAD_LIMIT_MB = 256.0


@dataclass(frozen=True, slots=True)
class Settings:
    """How this server listens and which files it uses."""

    host: str
    port: int  # 0: any free one
    port_is_wish: bool  # another may be taken where it is in use
    token_file: Path | None
    certificate: Path | None
    key: Path | None
    names: tuple[str, ...]  # further names by which browsers reach the server
    hal_write: bool
    upload_limit: int  # bytes
    program_folder: Path
    mdi_history_file: Path
    preference_file: Path
    log_file: Path | None

    @property
    def scheme(self) -> str:
        return "https" if self.certificate else "http"

    def tls(self) -> ssl.SSLContext | None:
        """The context of the listening socket; None: plain HTTP. ConfigError where the files are of no use."""
        if self.certificate is None:
            return None
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        try:
            context.load_cert_chain(self.certificate, self.key)
        except (OSError, ssl.SSLError) as reason:
            raise ConfigError(f"[WEB]TLS_CERTIFICATE, TLS_KEY: {self.certificate}, {self.key}: {reason}") from None
        return context


def read(ini: IniFile, host: str | None = None, port: int | None = None) -> Settings:
    """The settings of an INI file; the command line's host and port go before. ConfigError says what is wrong."""
    chosen_host = host or ini.find("WEB", "HOST", LOOPBACK)
    if port is None and os.environ.get(PORT_VARIABLE, "").isdecimal():
        port = int(os.environ[PORT_VARIABLE])
    chosen_port = port if port is not None else ini.integer("WEB", "PORT", DEFAULT_PORT, minimum=0, maximum=65535)
    settings = Settings(
        host=chosen_host,
        port=chosen_port,
        port_is_wish=port is None and namespace.VARIABLE in os.environ,
        token_file=ini.path("WEB", "TOKEN_FILE", None),
        certificate=ini.path("WEB", "TLS_CERTIFICATE", None),
        key=ini.path("WEB", "TLS_KEY", None),
        names=tuple((ini.find("WEB", "NAMES", "")).replace(",", " ").split()),
        hal_write=ini.boolean("WEB", "HAL_WRITE", False),
        upload_limit=int(ini.real("WEB", "UPLOAD_LIMIT", UPLOAD_LIMIT_MB, minimum=0.001, maximum=4096.0) * 1e6),
        program_folder=program_folder(ini),
        mdi_history_file=ini.path("DISPLAY", "MDI_HISTORY_FILE", Path.home() / ".axis_mdi_history"),
        preference_file=ini.path("DISPLAY", "PREFERENCE_FILE_PATH", _beside(ini, "preferences.json")),
        log_file=ini.path("DISPLAY", "LOG_FILE", None),
    )
    _refuse_an_open_door(settings)
    return settings


def of_wizard(port: int | None) -> Settings:
    """The wizard listens on this computer only and writes below ``~/linuxcnc/configs``."""
    place = Path.home() / "linuxcnc" / "configs"
    return Settings(
        host=LOOPBACK, port=DEFAULT_PORT if port is None else port, port_is_wish=port is None, token_file=None,
        certificate=None, key=None, names=(), hal_write=False, upload_limit=0, program_folder=place,
        mdi_history_file=place, preference_file=place, log_file=None,
    )  # fmt: skip


def program_folder(ini: IniFile) -> Path:
    """[DISPLAY]PROGRAM_PREFIX, from the INI file's folder; without it the folder of the INI file itself."""
    prefix = ini.find("DISPLAY", "PROGRAM_PREFIX")
    folder = ini.resolve(prefix) if prefix else ini.file.resolve().parent
    if not folder.is_dir():
        raise ini.error("DISPLAY", "PROGRAM_PREFIX", f"{folder}: no such folder")
    return folder.resolve()


def is_loopback(host: str) -> bool:
    """Whether only programs of this computer reach an address."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _beside(ini: IniFile, name: str) -> Path:
    """A file of the display in the INI file's folder, named after the INI file."""
    return ini.file.resolve().with_name(f"{ini.file.stem}.{name}")


def _refuse_an_open_door(settings: Settings) -> None:
    if (settings.certificate is None) != (settings.key is None):
        raise ConfigError("[WEB]TLS_CERTIFICATE and TLS_KEY belong together; one of them is missing")
    if is_loopback(settings.host):
        return
    missing = [
        name
        for name, value in (
            ("TOKEN_FILE", settings.token_file),
            ("TLS_CERTIFICATE", settings.certificate),
            ("TLS_KEY", settings.key),
        )
        if value is None
    ]
    if missing:
        raise ConfigError(
            f"[WEB]HOST {settings.host} can be reached from other computers, so [WEB]{', '.join(missing)} must be "
            f"given; {LOOPBACK} needs none of them"
        )
