"""Runs a command and tells what it spent, as JSON. A process of its own, because a child's peak of memory begins with that of the process
that made it: a harness that has read large results would be counted in.

    spent.py COMMAND...
"""

import json
import os
import subprocess
import sys
import time

begin = time.monotonic()
process = subprocess.Popen(sys.argv[1:], stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
text = process.stdout.read().decode(errors="replace")
_, status, usage = os.wait4(process.pid, 0)
process.returncode = os.waitstatus_to_exitcode(status)
print(json.dumps({"seconds": time.monotonic() - begin, "processor": usage.ru_utime + usage.ru_stime, "mib": usage.ru_maxrss / 1024,
                  "status": process.returncode, "text": text[-2000:]}))
