# SPDX-License-Identifier: MIT
"""Clients of a node's metrics, for prometheus_metrics.sh: prometheus_metrics.py PORT PROCESS
WHAT...; prints ok or FAIL a check."""
import os
import pathlib
import re
import socket
import subprocess
import sys
import threading
import time
import urllib.request

PORT, PROCESS = int(sys.argv[1]), int(sys.argv[2])
ROOT = pathlib.Path(__file__).resolve().parents[2]


def check(name, is_good, told=""):
    print(f"{'ok  ' if is_good else 'FAIL'} {name}" + ("" if is_good else f"\n     {told}"))


def connect():
    return socket.create_connection(("127.0.0.1", PORT), timeout=5)


def answer_to(request):
    """All that comes back, until the other side closes."""
    with connect() as here:
        here.sendall(request)
        data = b""
        while piece := here.recv(65536):
            data += piece
        return data


def status_of(request):
    return answer_to(request).split(b"\r\n")[0].decode()


def page():
    return urllib.request.urlopen(f"http://127.0.0.1:{PORT}/metrics", timeout=5).read().decode()


def values(text):
    """{(name, labels): value} by Prometheus' own parser for Python; families with HELP and TYPE."""
    from prometheus_client.parser import text_string_to_metric_families
    found, families = {}, {}
    for family in text_string_to_metric_families(text):
        families[family.name] = family
        for sample in family.samples:
            key = (sample.name, tuple(sorted(sample.labels.items())))
            assert key not in found, f"{key} is there twice"
            found[key] = sample.value
    return found, families


def of(found, name, /, **labels):
    return found["rhotrack_" + name, tuple(sorted(labels.items()))]


def check_text():
    text = page()
    found, families = values(text)
    check("each family has a HELP, a TYPE and a name of its own", all(
        family.documentation and family.type in ("counter", "gauge", "histogram")
        and name.startswith("rhotrack_") for name, family in families.items()), families)
    check("and there are many", len(families) > 60, len(families))
    counts = {name: of(found, f"{name}_total") for name in
              ("messages_in", "messages_sent", "steps", "plots", "tracks_confirmed")}
    pathlib.Path("counts").write_text("".join(f"{k}={int(v)}\n" for k, v in counts.items()))
    check("plots have a fate each", of(found, "plots_total") == sum(
        v for (name, _), v in found.items() if name == "rhotrack_plots_by_fate_total") > 0, found)
    check("steps are counted and measured", of(found, "steps_total") ==
          of(found, "step_seconds_count") == of(found, "latency_seconds_count") > 0, found)
    check("latencies hold the steps", of(found, "latency_seconds_sum") >=
          of(found, "step_seconds_sum") > 0, found)
    check("tracks now", of(found, "tracks", status="confirmed") >= 1, found)
    check("a sensor by number and name",
          of(found, "sensor_scans_total", sensor="1", name="north tower", kind="polar") > 0, found)
    check("what is learned of it", 0 < of(found, "sensor_pd", sensor="1", name="north tower",
                                          ring="0") <= 1 and
          of(found, "sensor_noise_factor", sensor="1", name="north tower", axis="range") > 0
          and of(found, "sensor_looks", sensor="1", name="north tower") > 0, found)
    check("rates of tracks' lives", 0 < of(found, "life_death_rate") < 0.1 and
          0 < of(found, "life_hide_rate") < 0.1 and 0 < of(found, "life_appear_rate") <= 2 and
          of(found, "life_lived_scans") > 0, found)
    check("zones", ("rhotrack_zone_tracks", (("zone", "7"),)) in found, found)
    check("work", 0 < of(found, "step_work") <= of(found, "step_work_worst"), found)
    check("refusals by cause: a datagram that is none, a message of a sensor that is not allowed",
          of(found, "refused_total", cause="datagrams_refused") == 1 and
          of(found, "refused_total", cause="messages_of_sensors_that_are_not_in_sensors_allowed")
          == 1, found)
    for tool in ("promtool", os.environ.get("PROMTOOL", "")):
        try:
            told = subprocess.run([tool, "check", "metrics"], input=text, text=True,
                                  capture_output=True)
            check("promtool has nothing to say", told.returncode == 0 and not told.stderr,
                  told.stderr)
            break
        except OSError:
            pass
    else:
        print("skipped: promtool is not there")
    time.sleep(0.2)
    later, _ = values(page())
    check("no counter falls", all(value <= later[key] for key, value in found.items()
                                  if re.search("_(total|count|bucket|sum)$", key[0])), later)


def check_counters():
    """Each counter of the library is in the text, or in the tallies that it also writes."""
    written = "".join((ROOT / "tools/rhotrack/live" / name).read_text()
                      for name in ("prometheus_metrics.c", "node_loss_counts.c"))
    for header, struct in (("scan_assembler", "rho_scan_assembler_counters"),
                           ("node", "rho_node_counters"),
                           ("tracker", "rho_tracker_counters"), ("tracker", "rho_tracker_work")):
        text = (ROOT / f"include/rhotrack/{header}.h").read_text()
        body = re.search(r"struct " + struct + r" \{(.*?)\n\};", text, re.S)[1]
        body = re.sub(r"/\*.*?\*/", "", body, flags=re.S)
        members = re.findall(r"(\w+)(?:\[\w+\])?\s*[,;]", body)
        missing = [member for member in members if not re.search(
            rf"(->|\.){member}\b", written) and member not in SHOWN_AS]
        check(f"all of {struct}: {len(members)}", len(members) > 3 and not missing, missing)


# of sequence_counts_losses, as in a node's last words
SHOWN_AS = {"scans_lost"}


def check_requests():
    good = b"GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n"
    cases = [
        ("a page", good, "200 OK"),
        ("with a query", b"GET /metrics?x=1 HTTP/1.0\r\n\r\n", "200 OK"),
        ("lines that end alone", b"GET /metrics HTTP/1.1\nHost: a\n\n", "200 OK"),
        ("another page", b"GET / HTTP/1.1\r\n\r\n", "404 Not Found"),
        ("a page below it", b"GET /metrics/../etc HTTP/1.1\r\n\r\n", "404 Not Found"),
        ("another method", b"POST /metrics HTTP/1.1\r\nContent-Length: 3\r\n\r\nabc",
         "405 Method Not Allowed"),
        ("no HTTP", b"metrics\r\n\r\n", "400 Bad Request"),
        ("an old form", b"GET /metrics\r\n\r\n", "400 Bad Request"),
        ("four words", b"GET /metrics HTTP/1.1 x\r\n\r\n", "400 Bad Request"),
        ("a NUL", b"GET /metrics\0 HTTP/1.1\r\n\r\n", "400 Bad Request"),
        ("any bytes", bytes(range(256)) * 8 + b"\r\n\r\n", "400 Bad Request"),
        ("a long head", b"GET /metrics HTTP/1.1\r\n" + b"X: y\r\n" * 2000 + b"\r\n",
         "431 Request Header Fields Too Large"),
    ]
    for name, request, expected in cases:
        try:
            got = status_of(request)
        except ConnectionError as error:
            got = str(error)
        check(f"{name}: {expected}", got == "HTTP/1.1 " + expected, got)
    head = answer_to(good.replace(b"GET", b"HEAD"))
    check("HEAD has the head alone", head.startswith(b"HTTP/1.1 200 ") and
          re.search(rb"Content-Length: [1-9]\d{3,}", head) and head.endswith(b"\r\n\r\n"), head)
    with connect() as here:
        for byte in good[:-1]:
            here.sendall(bytes([byte]))
        here.sendall(good[-1:])
        check("byte by byte", here.recv(15) == b"HTTP/1.1 200 OK")


def check_slow():
    begin = time.monotonic()
    with connect() as here:
        ended = None
        while time.monotonic() < begin + 6 and ended is None:
            try:
                here.sendall(b"G")
                here.settimeout(0.2)
                ended = time.monotonic() - begin if here.recv(1) == b"" else None
            except TimeoutError:
                pass
            except ConnectionError:
                ended = time.monotonic() - begin
        check("a client that sends a byte at a time is cut off in 2 s", ended and 1 < ended < 4,
              ended)
    idle = [connect() for _ in range(100)]
    begin = time.monotonic()
    text = page()
    took = time.monotonic() - begin
    check(f"idle clients hold no place ({took * 1e3:.0f} ms)", text and took < 1, took)
    for here in idle:
        here.close()


def open_files():
    return len(os.listdir(f"/proc/{PROCESS}/fd"))


def of_status(name):
    """Of the node's process, in kB."""
    text = pathlib.Path(f"/proc/{PROCESS}/status").read_text()
    return int(re.search(name + r":\s+(\d+)", text)[1])


def check_leaks():
    for _ in range(50):
        page()
    time.sleep(0.3)
    files, memory = open_files(), of_status("VmRSS")
    for i in range(1000):
        here = connect()
        if i % 4 == 0:
            here.sendall(b"GET /metrics HTTP/1.1\r\n\r\n")
        elif i % 4 == 1:
            here.sendall(b"GET /metrics HTTP/1.1\r\n\r\n")
            here.recv(100)  # and goes in the middle
        elif i % 4 == 2:
            here.sendall(b"GE")
        here.close()
    time.sleep(2.5)
    page()
    time.sleep(0.2)
    grown = of_status("VmRSS") - memory
    check(f"after 1000 connections: {open_files()} files open, as before", open_files() == files,
          files)
    if of_status("VmSize") > 1 << 32:
        print("skipped: a sanitizer keeps what is freed")
    else:
        check(f"and no more memory ({grown} kB)", grown < 300, grown)


def attack(seconds):
    """Clients that ask without end, that stay silent, that read nothing."""
    end = time.monotonic() + seconds
    counts = [0, 0, 0]

    def one(kind):
        while time.monotonic() < end:
            try:
                here = connect()
                if kind != 1:
                    here.sendall(b"GET /metrics HTTP/1.1\r\n\r\n" * 20)
                if kind == 0:
                    here.recv(100)
                if kind == 2:
                    time.sleep(0.05)
                here.close()
                counts[kind] += 1
            except OSError:
                pass

    threads = [threading.Thread(target=one, args=(i % 3,)) for i in range(9)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    print(*counts)


for what in sys.argv[3:]:
    if what.startswith("attack="):
        attack(float(what[7:]))
    else:
        globals()[f"check_{what}"]()
