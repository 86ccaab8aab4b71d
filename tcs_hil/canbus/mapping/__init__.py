"""Another car's DBC in place of ours: which of its signals mean what we need."""
