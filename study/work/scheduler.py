"""A client of the scheduler of a dask cluster. First its address is checked, and whether it answers."""

import logging
import re
import socket
import struct

ADDRESS = re.compile(r"(?:(tcp|tls|ws|wss|ucx)://)?(\[[0-9a-fA-F:.%]+\]|[\w.-]+):(\d{1,5})|inproc://.+", re.ASCII)
GREETING = 1_000_000  # largest number of bytes in the first message of a scheduler, which has some hundreds


def address_error(text: str) -> str:
    """The mistake in the form of an address; "" if there is none."""
    parts = ADDRESS.fullmatch(text)
    if parts and (parts[3] is None or 1 <= int(parts[3]) <= 65535):
        return ""
    return "must be the address of a dask scheduler, such as tcp://127.0.0.1:8786 or tls://HOST:PORT"


def connected(address: str, listens: float, answers: float):
    """A dask client of the scheduler at an address.

    Raises StudyError when nothing listens there within `listens` seconds, or no scheduler answers within `answers`.
    """
    from ..inputs.definition import StudyError  # here: it loads numpy, which `address_error` must not

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
        seconds = answers if _something_listens(address, listens, answers) else listens
        return Client(address, timeout=seconds, set_as_default=False)
    except MemoryError:
        raise
    except Exception as error:  # an answer that the client does not understand may raise anything
        words = str(error) or type(error).__name__
        raise StudyError([f"--scheduler {address}: no scheduler answers there ({words})"]) from None


def _something_listens(address: str, listens: float, answers: float) -> bool:
    """Whether something listens at the address.

    Raises OSError when the host has no address, or when the first bytes from it are not those of dask. Dask would take
    any first bytes as the length of a message, and allocate that much memory.
    """
    scheme, host, port = ADDRESS.fullmatch(address).groups()
    if host is None:
        return False
    try:
        peer = socket.create_connection((host.strip("[]"), int(port)), timeout=listens)
    except socket.gaierror as error:
        raise OSError(f"{host}: {error.strerror}") from None
    except OSError:  # perhaps the scheduler is about to start: the client asks again
        return False
    with peer, peer.makefile("rb") as stream:
        if scheme not in (None, "tcp"):
            return True
        peer.settimeout(answers)
        try:
            first = stream.read(8)
        except TimeoutError:
            raise OSError(f"it does not answer within {answers:g} s") from None
        if len(first) < 8 or struct.unpack("<Q", first)[0] > GREETING:
            raise OSError("something else listens there")
    return True
