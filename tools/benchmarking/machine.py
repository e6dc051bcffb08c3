"""What the measurements were made on."""
import os
import platform
import re
import subprocess


def thread_counts():
    """1, 2, 4 ... up to the processors that this process may use."""
    processors = len(os.sched_getaffinity(0))
    return [2**k for k in range(processors.bit_length()) if 2**k <= processors]


def first_match(pattern, text, default="unknown"):
    found = re.search(pattern, text)
    return found.group(1).strip() if found else default


def describe(build):
    """Pairs of a property and its value."""
    with open("/proc/cpuinfo", encoding="ascii") as file:
        processor = first_match(r"model name\s*:\s*(.*)", file.read())
    with open("/proc/meminfo", encoding="ascii") as file:
        memory = int(first_match(r"MemTotal:\s*(\d+)", file.read(), "0")) / 2**20
    cache = build / "CMakeCache.txt"
    text = cache.read_text(encoding="utf-8") if cache.exists() else ""
    compiler = subprocess.run([first_match(r"CMAKE_CXX_COMPILER:[A-Z]+=(.*)", text, "c++"), "--version"],
                              capture_output=True, text=True, check=False).stdout.split("\n")[0]
    version = subprocess.run([build / "quicksand", "--version"], capture_output=True, text=True, check=False).stdout
    return [("processor", f"{processor}, {len(os.sched_getaffinity(0))} usable of {os.cpu_count()}"),
            ("memory", f"{memory:.1f} GiB"), ("system", f"{platform.system()} {platform.release()}"),
            ("compiler", compiler), ("program", " ".join(version.split())),
            ("hypre", first_match(r"HYPRE_LIBRARY:FILEPATH=(.*)", text)),
            ("load before", " ".join(f"{load:.2f}" for load in os.getloadavg()))]
