"""Prints the slowest tests: slowest.py BUILD_FOLDER [COUNT]."""

import json
import pathlib
import sys

build, count = pathlib.Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 10
times = []
for file in (build / "test_times").glob("*.json"):
    for suite in json.loads(file.read_text())["testsuites"]:
        times += [(float(test["time"].rstrip("s")), f"{file.stem}: {suite['name']}.{test['name']}")
                  for test in suite["testsuite"] if test["status"] == "RUN"]
# Other tests, with the times of ctest.
log = build / "Testing" / "Temporary" / "CTestCostData.txt"
programs = {file.stem for file in (build / "test_times").glob("*.json")}
for line in log.read_text().splitlines() if log.exists() else []:
    fields = line.split()
    if len(fields) == 3 and fields[0] not in programs and not fields[0].startswith("test_"):
        times.append((float(fields[2]), fields[0]))
for seconds, name in sorted(times, reverse=True)[:count]:
    print(f"{seconds:9.1f} s  {name}")
