"""The sub-commands of `polaris-nl`: each module has `run(arguments) -> exit code`."""
