"""Engines: one module a subcommand, each turns a value of geometry into another."""
