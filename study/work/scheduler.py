"""A client of the scheduler of a dask cluster, and checks of its address and of whether it answers."""

import logging
import re
import socket
import struct

ADDRESS = re.compile(r"(?:(tcp|tls|ws|wss|ucx)://)?(\[[0-9a-fA-F:.%]+\]|[\w.-]+):(\d{1,5})|inproc://.+", re.ASCII)
GREETING = 1_000_000  # most bytes of the first message of a scheduler; it has some hundreds


def address_error(text: str) -> str:
    """What is wrong with the form of an address, "" if nothing is."""
    found = ADDRESS.fullmatch(text)
    if found and (found[3] is None or 1 <= int(found[3]) <= 65535):
        return ""
    return "must be the address of a dask scheduler, such as tcp://127.0.0.1:8786 or tls://HOST:PORT"


def connected(address: str, seconds: float):
    """A dask client of the scheduler at an address.

    Raises StudyError when nothing answers there in so many seconds, or what answers is no scheduler.
    """
    from ..spec.definition import StudyError  # here: it imports numpy, and a message about an address need not wait

    reason = address_error(address)
    if reason:
        raise StudyError([f"--scheduler {address}: {reason}"])
    try:
        from dask.distributed import Client
    except ImportError:
        raise StudyError(["--scheduler needs the package distributed: pip install 'roughcoat[cluster]'"]) from None
    logging.getLogger("distributed.client").setLevel(logging.CRITICAL)  # its messages are long; `Lost` says the same
    try:
        if address.startswith(("tls:", "wss:")):
            from dask.distributed import Security

            if not Security().get_connection_args("client")["ssl_context"]:
                raise OSError("TLS needs certificates, which dask's configuration must name: see docs/cluster.md")
        _greeted(address, seconds)
        return Client(address, timeout=seconds, set_as_default=False)
    except Exception as error:  # what the client raises for an answer that it does not understand is not known
        said = str(error) or type(error).__name__
        raise StudyError([f"--scheduler {address}: no scheduler answers there ({said})"]) from None


def _greeted(address: str, seconds: float) -> None:
    """Raise OSError when the host has no address, or when the first bytes from there are not those of dask.

    Dask takes the first bytes as the length of a message, whatever they are, and asks for that much memory.
    """
    scheme, host, port = ADDRESS.fullmatch(address).groups()
    if host is None or scheme not in (None, "tcp"):
        return
    where = (host.strip("[]"), int(port))
    try:
        peer = socket.create_connection(where, timeout=seconds)
    except socket.gaierror as error:
        raise OSError(f"{host}: {error.strerror}") from None
    except OSError:  # perhaps the scheduler is about to start: the client asks again
        return
    with peer, peer.makefile("rb") as stream:
        try:
            first = stream.read(8)
        except TimeoutError:
            raise OSError(f"it says nothing in {seconds:g} s") from None
        if len(first) < 8 or struct.unpack("<Q", first)[0] > GREETING:
            raise OSError("something else listens there")
