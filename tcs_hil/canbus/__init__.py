"""DBC to signals and back, end-to-end protection, and the bus itself."""
