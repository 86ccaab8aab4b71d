"""A recorded bus fed to the service again, in process or live, and what it then says compared."""
