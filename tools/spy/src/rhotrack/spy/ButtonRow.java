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

/**
 * The row of buttons above the views, each with a keyboard shortcut. A button is lit while its
 * option is on.
 */
final class ButtonRow {
    private final JComponent keyOwner;
    private final JPanel row = new JPanel(new FlowLayout(FlowLayout.LEFT, 6, 6));
    private final Map<JButton, BooleanSupplier> states = new HashMap<>();

    /** Shortcuts work wherever the focus is in the window of `keyOwner`. */
    ButtonRow(JComponent keyOwner) {
        this.keyOwner = keyOwner;
        row.setBackground(Palette.PANEL);
    }

    JComponent component() {
        return row;
    }

    void addButton(String title, String key, BooleanSupplier isOn, Runnable job) {
        JButton button = new JButton(title);
        button.setToolTipText("key " + key.toLowerCase(Locale.ROOT));
        // the space key then pauses instead of pressing the last button again
        button.setFocusable(false);
        button.setContentAreaFilled(false);
        button.setOpaque(true);
        button.setFont(Palette.PLAIN);
        button.setBorder(BorderFactory.createCompoundBorder(
                BorderFactory.createLineBorder(Palette.EDGE),
                BorderFactory.createEmptyBorder(3, 10, 3, 10)));
        button.addActionListener(event -> runAndRefresh(job));
        states.put(button, isOn);
        row.add(button);
        bindKey(key, job);
        refreshButtons();
    }

    void addGap() {
        JPanel space = new JPanel();
        space.setOpaque(false);
        space.setPreferredSize(new Dimension(10, 1));
        row.add(space);
    }

    /** Binds a key, in KeyStroke's notation ("P", "SPACE", "typed +"), to a job. */
    @SuppressWarnings("serial") // actions are never serialised
    void bindKey(String key, Runnable job) {
        keyOwner.getInputMap(JComponent.WHEN_IN_FOCUSED_WINDOW)
                .put(KeyStroke.getKeyStroke(key), key);
        keyOwner.getActionMap().put(key, new AbstractAction() {
            @Override
            public void actionPerformed(ActionEvent event) {
                runAndRefresh(job);
            }
        });
    }

    private void runAndRefresh(Runnable job) {
        job.run();
        refreshButtons();
    }

    private void refreshButtons() {
        states.forEach((button, isOn) -> {
            Color lit = isOn.getAsBoolean() ? Palette.EDGE : Palette.PANEL;
            button.setBackground(lit);
            button.setForeground(isOn.getAsBoolean() ? Palette.TEXT : Palette.MUTED);
        });
    }
}
