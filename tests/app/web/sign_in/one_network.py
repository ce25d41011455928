"""A network namespace of its own, in which a shipped file of a proxy is used unchanged.

`python one_network.py PROXY FILE FOLDER JOB.py` runs as the first process of `unshare --net --mount`: there
port 443 and /etc/ssl belong to it alone. It starts the proxy with the file, and then runs the job.
"""

import datetime
import fcntl
import os
import runpy
import socket
import struct
import subprocess
import sys
import time
from pathlib import Path

NAME = "bearings.example.com"
UP, SET_FLAGS = 0x41, 0x8914  # IFF_UP | IFF_RUNNING, SIOCSIFFLAGS

NGINX = """
daemon off; pid {folder}/nginx.pid; error_log {folder}/nginx.log;
events {{ }}
http {{
    access_log off;
    client_body_temp_path {folder}/body; proxy_temp_path {folder}/proxy; fastcgi_temp_path {folder}/fastcgi;
    uwsgi_temp_path {folder}/uwsgi; scgi_temp_path {folder}/scgi;
    include {file};
}}
"""
CADDY = """
{{
    local_certs
    skip_install_trust
    admin off
    storage file_system {folder}/caddy
}}
import {file}
"""


def loopback_up():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        fcntl.ioctl(any_socket, SET_FLAGS, struct.pack("16sh14x", b"lo", UP))


def certificate(folder):
    """Write a certificate of the name, signed by itself, where the shipped files expect it."""
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes, serialization
    from cryptography.hazmat.primitives.asymmetric import ec

    key = ec.generate_private_key(ec.SECP256R1())
    who = x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, NAME)])
    present = datetime.datetime.now(datetime.UTC)
    made = x509.CertificateBuilder().subject_name(who).issuer_name(who).public_key(key.public_key())
    made = (
        made.serial_number(1).not_valid_before(present).not_valid_after(present + datetime.timedelta(days=1))
    )
    made = made.add_extension(x509.SubjectAlternativeName([x509.DNSName(NAME)]), critical=False)
    pem = made.sign(key, hashes.SHA256()).public_bytes(serialization.Encoding.PEM)
    private = key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    for place, text in (("certs", pem), ("private", private)):
        own = folder / place
        own.mkdir()
        (own / f"{NAME}.{'pem' if place == 'certs' else 'key'}").write_bytes(text)
        mount(own, f"/etc/ssl/{place}")


def mount(own, place):
    os.makedirs(place, exist_ok=True)
    subprocess.run(["mount", "--bind", str(own), place], check=True)


def password_file(folder):
    """Write the password file of nginx: the name engineer, the password crankshaft."""
    own = folder / "nginx"
    own.mkdir()
    hashed = subprocess.run(
        ["openssl", "passwd", "-apr1", "crankshaft"], capture_output=True, text=True, check=True
    )
    (own / "crankwright.htpasswd").write_text(f"engineer:{hashed.stdout.strip()}\n")
    own.chmod(0o755)
    mount(own, "/etc/nginx")


def command(proxy, file, folder):
    text = {"nginx": NGINX, "caddy": CADDY}[proxy].format(folder=folder, file=file)
    whole = folder / "whole.conf"
    whole.write_text(text)
    if proxy == "nginx":
        return ["nginx", "-p", str(folder), "-c", str(whole)]
    return ["caddy", "run", "--config", str(whole), "--adapter", "caddyfile"]


def listening(port):
    for _ in range(300):
        with socket.socket() as one:
            if one.connect_ex(("127.0.0.1", port)) == 0:
                return
        time.sleep(0.1)
    raise AssertionError(f"nothing listens on port {port}")


if __name__ == "__main__":
    proxy, file, folder, job = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]), sys.argv[4]
    loopback_up()
    if proxy == "nginx":
        certificate(folder)
        password_file(folder)
    folder.chmod(0o755)
    started = subprocess.Popen(
        command(proxy, file, folder),
        stderr=(folder / "proxy.log").open("w"),
        env={**os.environ, "HOME": str(folder)},
    )
    try:
        listening(443)
        runpy.run_path(job, run_name="__main__")
    finally:
        started.terminate()
        started.wait(20)
