"""Only clients with a certificate of the same authority may connect to a scheduler over TLS."""

import datetime
import ipaddress

import pytest
from dask_processes import Network, commanded
from patience import until

from app.settings import Settings
from app.workers.remote.engine import DaskWorker

pytest.importorskip("cryptography")

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec

DAY = datetime.timedelta(days=1)


class Authority:
    """An authority and one certificate that it has signed, in files of a folder."""

    def __init__(self, folder):
        folder.mkdir()
        self.files = {name: folder / f"{name}.pem" for name in ("dask_ca", "dask_cert", "dask_key")}
        self._key, self._name = ec.generate_private_key(ec.SECP256R1()), _name(f"authority of {folder.name}")
        own = self._signed(self._name, self._key, x509.BasicConstraints(ca=True, path_length=0))
        key = ec.generate_private_key(ec.SECP256R1())
        address = x509.SubjectAlternativeName([x509.IPAddress(ipaddress.ip_address("127.0.0.1"))])
        self.files["dask_ca"].write_bytes(own.public_bytes(serialization.Encoding.PEM))
        self.files["dask_cert"].write_bytes(
            self._signed(_name("a machine"), key, address).public_bytes(serialization.Encoding.PEM)
        )
        self.files["dask_key"].write_bytes(
            key.private_bytes(
                serialization.Encoding.PEM,
                serialization.PrivateFormat.PKCS8,
                serialization.NoEncryption(),
            )
        )

    @property
    def environment(self):
        return {f"CRANKWRIGHT_{name.upper()}": str(file) for name, file in self.files.items()}

    def _signed(self, subject, key, extension):
        now = datetime.datetime.now(datetime.UTC)
        certificate = x509.CertificateBuilder(
            self._name, subject, key.public_key(), x509.random_serial_number()
        )
        certificate = certificate.not_valid_before(now - DAY).not_valid_after(now + DAY)
        return certificate.add_extension(extension, critical=True).sign(self._key, hashes.SHA256())


def _name(text):
    return x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, text)])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("tls")


@pytest.fixture(scope="module")
def ours(folder):
    return Authority(folder / "ours")


@pytest.fixture(scope="module")
def theirs(folder):
    return Authority(folder / "theirs")


@pytest.fixture(scope="module")
def network(folder, ours):
    network = Network(folder, workers=1, scheme="tls", **ours.environment)
    yield network
    network.stop()


def refusal(engine, caplog):
    """Why a server's worker is not connected."""
    try:
        until(lambda: "no connection to the scheduler" in caplog.text)
        assert engine.capacity("geometry") == 0
        assert not engine.answers()
        return caplog.text
    finally:
        engine.close()


@pytest.mark.slow
def test_certificates_of_one_authority_connect(network, ours):
    engine = network.engine(**ours.files)
    assert engine.run(max, 1, 2) == 2
    engine.close()


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:unclosed:ResourceWarning")  # of attempts that Dask gives up
def test_a_server_with_certificates_of_another_authority_is_refused(network, theirs, caplog):
    engine = DaskWorker.of(Settings(engine=network.address, **theirs.files))
    assert "connected to the scheduler" not in refusal(engine, caplog)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:unclosed:ResourceWarning")  # of attempts that Dask gives up
def test_a_server_without_certificate_is_refused(network, caplog):
    engine = DaskWorker.of(Settings(engine=network.address.replace("tls://", "tcp://")))
    assert "connected to the scheduler" not in refusal(engine, caplog)


@pytest.mark.slow
def test_a_worker_with_certificates_of_another_authority_gets_no_work(network, ours, theirs, folder):
    engine = network.engine(**ours.files)
    options = ("--scheduler", network.address, "--lanes", '{"geometry": 5}')
    stranger = commanded("stranger", folder, "worker", *options, **theirs.environment)
    scheduler = network.scheduler.log
    until(lambda: scheduler.read_text(), lambda text: "handshake failed" in text)
    assert engine.capacity("geometry") == 1
    assert stranger.lives
    stranger.stop()
    engine.close()
