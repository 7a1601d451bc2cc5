// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Color;
import java.awt.Dimension;
import java.awt.FlowLayout;
import java.awt.event.ActionEvent;
import java.util.HashMap;
import java.util.Locale;
import java.util.Map;
import java.util.function.BooleanSupplier;
import javax.swing.AbstractAction;
import javax.swing.BorderFactory;
import javax.swing.JButton;
import javax.swing.JComponent;
import javax.swing.JPanel;
import javax.swing.KeyStroke;

/** The row of buttons, each with its key. A button is lit while what it stands for is on. */
final class Controls {
    private final JComponent keyOwner;
    private final JPanel row = new JPanel(new FlowLayout(FlowLayout.LEFT, 6, 6));
    private final Map<JButton, BooleanSupplier> states = new HashMap<>();

    /** Keys work wherever the focus is in the window of `keyOwner`. */
    Controls(JComponent keyOwner) {
        this.keyOwner = keyOwner;
        row.setBackground(Palette.PANEL);
    }

    JComponent row() {
        return row;
    }

    void button(String title, String key, BooleanSupplier isOn, Runnable job) {
        JButton button = new JButton(title);
        button.setToolTipText("key " + key.toLowerCase(Locale.ROOT));
        button.setFocusable(false); // so that space pauses and does not press the last button again
        button.setContentAreaFilled(false);
        button.setOpaque(true);
        button.setFont(Palette.PLAIN);
        button.setBorder(BorderFactory.createCompoundBorder(BorderFactory.createLineBorder(Palette.EDGE),
                BorderFactory.createEmptyBorder(3, 10, 3, 10)));
        button.addActionListener(event -> run(job));
        states.put(button, isOn);
        row.add(button);
        key(key, job);
        refresh();
    }

    void gap() {
        JPanel space = new JPanel();
        space.setOpaque(false);
        space.setPreferredSize(new Dimension(10, 1));
        row.add(space);
    }

    /** A key as KeyStroke reads it: "P", "SPACE", "typed +". */
    @SuppressWarnings("serial") // nobody stores actions
    void key(String key, Runnable job) {
        keyOwner.getInputMap(JComponent.WHEN_IN_FOCUSED_WINDOW).put(KeyStroke.getKeyStroke(key), key);
        keyOwner.getActionMap().put(key, new AbstractAction() {
            @Override
            public void actionPerformed(ActionEvent event) {
                run(job);
            }
        });
    }

    private void run(Runnable job) {
        job.run();
        refresh();
    }

    private void refresh() {
        states.forEach((button, isOn) -> {
            Color lit = isOn.getAsBoolean() ? Palette.EDGE : Palette.PANEL;
            button.setBackground(lit);
            button.setForeground(isOn.getAsBoolean() ? Palette.TEXT : Palette.MUTED);
        });
    }
}
