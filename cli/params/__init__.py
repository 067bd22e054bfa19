"""Option types: arguments of the command line turned into values of the library."""
