"""From utterances to edits, questions, answers, commands and refusals."""
