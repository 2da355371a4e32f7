#!/usr/bin/env python3
"""Prints the contact of each line of gauge readings on standard input (volts, separated by spaces).

usage: sensor | live.py FINGER.yaml
"""

import sys

import finray

live = finray.Live(finray.Finger.read(sys.argv[1]), finray.Scene(most_contacts=1))
for line in sys.stdin:
    frame = live.next([float(word) for word in line.split()])
    if frame.status == "ok":
        contact = frame.contacts[0]
        print(f"ok {contact.arc_mm:.2f} mm {contact.normal_N:.3f} N", flush=True)
    else:
        print(frame.status, flush=True)
