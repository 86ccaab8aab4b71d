"""A place with a real `vcan0` for any command, on any Linux machine; standard library only.

The host's half is `cli`, `native` and `uml`; the guest's half is `guest` (its PID 1) and `root`.
`job` is what one tells the other, `interface` and `kernelcalls` are used by both.
"""
