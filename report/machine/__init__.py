"""The program on its machine: processes, signals, files moved in whole, what is kept from run to run."""
