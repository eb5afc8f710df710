"""The scheduler of a dask cluster: whether its address is one, whether it answers, and a client of it."""

import logging
import re
import socket
import struct

ADDRESS = re.compile(r"(?:(tcp|tls|ws|wss|ucx)://)?(\[[0-9a-fA-F:.%]+\]|[\w.-]+):(\d{1,5})|inproc://.+", re.ASCII)
GREETING = 1_000_000  # bytes of the first message of a scheduler, which are some hundreds


def address_error(text: str) -> str:
    """What is wrong with the form of an address, "" if nothing is."""
    found = ADDRESS.fullmatch(text)
    if found and (found[3] is None or 1 <= int(found[3]) <= 65535):
        return ""
    return "must be the address of a dask scheduler, such as tcp://127.0.0.1:8786 or tls://HOST:PORT"


def connected(address: str, seconds: float):
    """A dask client of the scheduler at an address.

    Raises
    ------
    StudyError : nothing answers there in so many seconds, or what answers is no scheduler
    """
    from ..spec.definition import StudyError  # imports numpy, for which a complaint about an address does not wait

    reason = address_error(address)
    if reason:
        raise StudyError([f"--scheduler {address}: {reason}"])
    try:
        from dask.distributed import Client
    except ImportError:
        raise StudyError(["--scheduler needs the package distributed: pip install 'roughcoat[cluster]'"]) from None
    logging.getLogger("distributed.client").setLevel(logging.CRITICAL)  # says at length what `Lost` says
    try:
        if address.startswith(("tls:", "wss:")):
            _certified()
        _greeted(address, seconds)
        return Client(address, timeout=seconds, set_as_default=False)
    except Exception as error:  # the client makes any of what it hears and does not understand
        said = str(error) or type(error).__name__
        raise StudyError([f"--scheduler {address}: no scheduler answers there ({said})"]) from None


def _certified() -> None:
    """Raise OSError when dask's configuration names no certificates."""
    from dask.distributed import Security

    if not Security().get_connection_args("client")["ssl_context"]:
        raise OSError("TLS needs certificates, which dask's configuration must name: see docs/cluster.md")


def _greeted(address: str, seconds: float) -> None:
    """Raise OSError for a host that has no address, and when who listens there does not greet as dask does.

    Dask takes the first bytes for the length of a message whatever they are, and tries to find that much memory.
    """
    scheme, host, port = ADDRESS.fullmatch(address).groups()
    if host is None or scheme not in (None, "tcp"):
        return
    where = (host.strip("[]"), int(port))
    try:
        socket.getaddrinfo(*where)
    except socket.gaierror as error:
        raise OSError(f"{host}: {error.strerror}") from None
    try:
        peer = socket.create_connection(where, timeout=seconds)
    except OSError:  # perhaps it is about to start: the client goes on asking
        return
    with peer, peer.makefile("rb") as stream:
        try:
            first = stream.read(8)
        except TimeoutError:
            raise OSError(f"it says nothing in {seconds:g} s") from None
        if len(first) < 8 or struct.unpack("<Q", first)[0] > GREETING:
            raise OSError("something else listens there")
